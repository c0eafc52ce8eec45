#include <fmt/format.h>

#include <cmath>

#include "kaustik/base/limits.h"
#include "kaustik/volume/volume_kinds.h"

namespace kaustik {
namespace {

const TypeInfo& gridvolume_info() {
  static const TypeInfo info{
      "volume",
      "gridvolume",
      "Samples over the cube from (0, 0, 0) to (1, 1, 1), from a file or a buffer.",
      {file_parameter("filename",
                      "File of Mitsuba's format VOL: floats or bytes, 1, 3 or 6 channels."),
       array_parameter("data", {},
                       "Samples [z, y, x] or [z, y, x, 1, 3 or 6] from a program's buffer, instead "
                       "of the file: uint8, uint16, float32 or float64.")
           .instead_of("filename"),
       choice_parameter("filter_type", "trilinear", {"trilinear", "nearest"},
                        "Interpolation between samples."),
       choice_parameter("wrap_mode", "clamp", {"clamp", "repeat", "mirror"},
                        "Values outside the cube. Density always ends there."),
       boolean_parameter("use_grid_bbox", false,
                         "Puts the samples into the box that the file gives, instead of the cube."),
       to_world_parameter("Places the cube, or the file's box, in the world."),
       ignored_parameter("raw", ParameterKind::boolean),
       ignored_parameter("accel", ParameterKind::boolean),
       ignored_parameter("max_value", ParameterKind::number),
       ignored_parameter("send_data", ParameterKind::boolean)}};
  return info;
}

VolumeSamples samples_of(const Arguments& arguments) {
  const auto& buffer = arguments.array("data");
  if (!buffer) return read_vol(arguments.text("filename"));
  try {
    return samples_of_array(*buffer);
  } catch (const Error& error) {
    std::vector<Problem> problems = error.problems();
    for (Problem& problem : problems) problem.place = arguments.place_of("data");
    throw Error(error.kind(), std::move(problems));
  }
}

/// Takes the cube to the box that the file tells.
Transform box_from_unit(const VolumeSamples& samples, const Arguments& arguments) {
  if (!samples.box)
    throw Error(ErrorKind::input, "a buffer has no box for 'use_grid_bbox'",
                "place the samples by 'to_world'", arguments.place_of("use_grid_bbox"));
  const Vec3d least(samples.box->min), size = Vec3d(samples.box->max) - least;
  for (int axis = 0; axis < 3; ++axis)
    if (!(size[axis] >= smallest_length && size[axis] <= largest_length &&
          std::fabs(least[axis]) <= largest_length))
      throw Error(ErrorKind::input,
                  fmt::format("the volume's box reaches from {:g} to {:g} along {}", least[axis],
                              least[axis] + size[axis], "xyz"[axis]),
                  "export the file with a box that has a size, or leave 'use_grid_bbox' out",
                  arguments.place_of("use_grid_bbox"));
  return Transform::translate(least) * Transform::scale(size);
}

void check_affine(const Transform& to_world, const Arguments& arguments) {
  if (to_world.at(3, 0) == 0 && to_world.at(3, 1) == 0 && to_world.at(3, 2) == 0 &&
      std::fabs(to_world.at(3, 3) - 1) <= 1e-6)
    return;
  throw Error(ErrorKind::input, "'to_world' of a volume is a projection",
              "the last row of the matrix has to be 0 0 0 1", arguments.place_of("to_world"));
}

/// Grids that are thin along an axis or two take up to ten times their samples.
void check_memory(const VolumeSamples& samples, GridVolume::Filter filter, const Place& place) {
  constexpr double most = 0x1p31;
  const double kept = GridVolume::most_kept_values(samples, filter);
  if (kept <= most) return;
  throw Error(ErrorKind::input,
              fmt::format("a grid of {} x {} x {} cells may take {:.3g} GB", samples.size[0],
                          samples.size[1], samples.size[2], kept * sizeof(float) / 1e9),
              "give it cells that are as many along each axis", place);
}

Place place_of_samples(const Arguments& arguments) {
  return arguments.place_of(arguments.array("data") ? "data" : "filename");
}

std::shared_ptr<const Volume> create_gridvolume(const Arguments& arguments) {
  const Transform& to_world = arguments.transform("to_world");
  check_affine(to_world, arguments);
  const VolumeSamples samples = samples_of(arguments);
  Transform world_from_unit = to_world;
  if (arguments.boolean("use_grid_bbox"))
    world_from_unit = to_world * box_from_unit(samples, arguments);
  using Wrap = GridVolume::Wrap;
  const auto filter = arguments.text("filter_type") == "nearest" ? GridVolume::Filter::nearest
                                                                 : GridVolume::Filter::trilinear;
  check_memory(samples, filter, place_of_samples(arguments));
  const std::string& wrap = arguments.text("wrap_mode");
  return std::make_shared<Volume>(GridVolume(samples, filter,
                                             wrap == "repeat"   ? Wrap::repeat
                                             : wrap == "mirror" ? Wrap::mirror
                                                                : Wrap::clamp,
                                             world_from_unit));
}

}  // namespace

VolumeType gridvolume_type() { return {gridvolume_info(), create_gridvolume}; }

}  // namespace kaustik
