// Media whose density is a grid, and files and clouds that become one.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kaustik/loader/nanovdb_file.h"
#include "kaustik/loader/pbrt/cloud_density.h"
#include "kaustik/loader/pbrt/media.h"

namespace kaustik::pbrt {
namespace {

/// Of a file of NanoVDB, and what its dense grid may take whatever the file's size.
constexpr size_t most_nanovdb_bytes = size_t{8} << 30, always_kept_bytes = size_t{64} << 20;

/// Along the longest side of its box.
constexpr size_t cells_along_cloud = 128;

/// Samples along x, y and z. Throws Error(input) unless there are as many numbers.
std::array<size_t, 3> grid_size(const ParameterList& list, const Parameter& samples,
                                size_t components) {
  std::array<size_t, 3> size{};
  const char* const names[] = {"nx", "ny", "nz"};
  size_t count = components;
  for (size_t i = 0; i < 3; ++i) {
    size[i] = size_t(std::clamp(list.integer(names[i], 1), 0, 1 << 20));
    count = size[i] == 0 || count > samples.number_count() ? 0 : count * size[i];
  }
  if (count == 0 || count != samples.number_count())
    throw Error(ErrorKind::input,
                fmt::format("{} has {} numbers, and nx, ny, nz ask for others", shown(samples.name),
                            samples.number_count()),
                "give one for each cell", samples.place);
  return size;
}

Rgb sum(const Rgb& a, const Rgb& b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }

double share(double part, double whole) { return whole > 0 ? std::min(part / whole, 1.0) : 0; }

Rgb albedo_of(const Rgb& scattering, const Rgb& extinction) {
  return {share(scattering.r, extinction.r), share(scattering.g, extinction.g),
          share(scattering.b, extinction.b)};
}

}  // namespace

std::shared_ptr<Object> Media::grid_volume(const MediumDefinition& definition,
                                           std::vector<size_t> extents, std::vector<float> samples,
                                           const Transform& to_world) {
  auto volume = described("volume", "gridvolume", definition.parameters.place());
  set(*volume, "data", Value(Array::of<float>(std::move(extents), std::move(samples))));
  set(*volume, "to_world", to_world);
  return volume;
}

Media::Box Media::box_of(const MediumDefinition& definition) {
  const ParameterList& list = definition.parameters;
  Vec3d low = list.point("p0").value_or(Vec3d(0, 0, 0));
  Vec3d high = list.point("p1").value_or(Vec3d(1, 1, 1));
  for (int axis = 0; axis < 3; ++axis)
    if (low[axis] > high[axis]) std::swap(low[axis], high[axis]);
  const Vec3d size = high - low;
  if (!(size.x > 0 && size.y > 0 && size.z > 0))
    throw Error(ErrorKind::input, "the grid's box has no volume",
                "let p0 and p1 differ in x, y and z", list.place_of("p1"));
  return {low, size, definition.to_world * Transform::translate(low) * Transform::scale(size)};
}

Media::Coefficients Media::coefficients(const MediumDefinition& definition) {
  const Rgb scattering = coefficient(definition, "sigma_s");
  return {scattering, sum(coefficient(definition, "sigma_a"), scattering)};
}

template <typename Number>
std::shared_ptr<Object> Media::with_density(const MediumDefinition& definition,
                                            const Coefficients& coefficients,
                                            std::span<const Number> density,
                                            const std::array<size_t, 3>& size,
                                            const Transform& to_world) {
  const ParameterList& list = definition.parameters;
  const size_t components = coefficients.components();
  std::vector<float> samples;
  samples.reserve(density.size() * components);
  const Rgb& extinction = coefficients.extinction;
  const double parts[3] = {extinction.r, extinction.g, extinction.b};
  for (const Number value : density)
    for (size_t i = 0; i < components; ++i)
      samples.push_back(float(std::max(double(value), 0.0) * parts[i]));
  std::vector<size_t> extents = {size[2], size[1], size[0]};
  if (components > 1) extents.push_back(components);
  auto medium = described("medium", "heterogeneous", list.place());
  set(*medium, "albedo", albedo_of(coefficients.scattering, extinction));
  set(*medium, "scale", std::max(list.number("scale", 1), 0.0));
  hold(*medium, "sigma_t",
       grid_volume(definition, std::move(extents), std::move(samples), to_world));
  return with_phase(medium, definition);
}

std::shared_ptr<Object> Media::make_nanovdb(const MediumDefinition& definition) {
  const ParameterList& list = definition.parameters;
  const std::string file = list.text("filename"), grid = list.text("gridname", "density");
  const auto path = file.empty() ? std::nullopt : files_.find(file, list.place());
  list.accept({"temperaturename"});
  if (!path) {
    deviations_.missing(definition.owner.object,
                        fmt::format("there is no file {}: space is empty there", shown(file)),
                        list.place_of("filename"), where_files_lie);
    return nullptr;
  }
  const std::vector<uint8_t> bytes = files_.bytes_of(*path, most_nanovdb_bytes, list.place());
  const Coefficients coefficients = this->coefficients(definition);
  const size_t most_samples =
      (always_kept_bytes + 4 * bytes.size()) / (coefficients.components() * sizeof(float));
  DenseGrid dense;
  try {
    dense = read_nanovdb(bytes, grid, most_samples, place_in(path->string()));
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input) throw;
    deviations_.missing(definition.owner.object,
                        fmt::format("{} cannot be read: {}: space is empty there", shown(file),
                                    error.problems().front().message),
                        list.place_of("filename"), error.problems().front().remedy);
    return nullptr;
  }
  if (dense.voxels_per_sample > 1)
    deviations_.approximated(
        definition.owner.object,
        fmt::format("its grid is {0} times as coarse along each axis as in the file, whose box is "
                    "mostly empty",
                    dense.voxels_per_sample),
        list.place_of("filename"));
  return with_density(definition, coefficients, std::span<const float>(dense.samples), dense.size,
                      definition.to_world * dense.to_world);
}

std::shared_ptr<Object> Media::make_grid(const MediumDefinition& definition) {
  const ParameterList& list = definition.parameters;
  const Parameter* density = list.find("density", {"float"});
  if (!density)
    throw Error(ErrorKind::input, fmt::format("{} has no density", definition.owner.object),
                "give it \"float density\" [ … ]", list.place());
  const std::array<size_t, 3> size = grid_size(list, *density, 1);
  const Coefficients coefficients = this->coefficients(definition);
  files_.spend(density->number_count() * coefficients.components() * sizeof(float), list.place());
  return with_density(definition, coefficients, std::span<const double>(density->numbers), size,
                      box_of(definition).to_world);
}

std::shared_ptr<Object> Media::make_cloud(const MediumDefinition& definition) {
  const ParameterList& list = definition.parameters;
  constexpr double most = 1e6;
  const CloudShape cloud = {std::clamp(list.number("density", 1), -most, most),
                            std::clamp(list.number("wispiness", 1), 0.0, most),
                            std::clamp(list.number("frequency", 5), -most, most)};
  const Box box = box_of(definition);
  const double longest = std::max({box.size.x, box.size.y, box.size.z});
  std::array<size_t, 3> size{};
  for (int axis = 0; axis < 3; ++axis)
    size[size_t(axis)] = size_t(std::ceil(box.size[axis] / longest * double(cells_along_cloud)));
  const Coefficients coefficients = this->coefficients(definition);
  const size_t count = size[0] * size[1] * size[2];
  files_.spend(count * (1 + coefficients.components()) * sizeof(float), list.place());
  const std::vector<float> density = cloud_densities(cloud, box.low, box.size, size);
  deviations_.approximated(
      definition.owner.object,
      fmt::format("its density is sampled in {} × {} × {} cells, and linear between their middles",
                  size[0], size[1], size[2]),
      list.place());
  return with_density(definition, coefficients, std::span<const float>(density), size,
                      box.to_world);
}

std::shared_ptr<Object> Media::make_colour_grid(const MediumDefinition& definition) {
  const ParameterList& list = definition.parameters;
  const Parameter *absorption = list.find("sigma_a", {"rgb"}),
                  *scattering = list.find("sigma_s", {"rgb"});
  if (!absorption && !scattering)
    throw Error(ErrorKind::input, fmt::format("{} has no coefficients", definition.owner.object),
                "give it \"rgb sigma_a\" and \"rgb sigma_s\"", list.place());
  const std::array<size_t, 3> size = grid_size(list, *(absorption ? absorption : scattering), 3);
  if (scattering) grid_size(list, *scattering, 3);
  std::vector<float> extinctions, albedos;
  const size_t count = 3 * size[0] * size[1] * size[2];
  extinctions.reserve(count);
  albedos.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    // What is not given is 1, as pbrt has it.
    const double a = absorption ? std::max(absorption->numbers[i], 0.0) : 1.0;
    const double s = scattering ? std::max(scattering->numbers[i], 0.0) : 1.0;
    extinctions.push_back(float(a + s));
    albedos.push_back(float(share(s, a + s)));
  }
  files_.spend((extinctions.size() + albedos.size()) * sizeof(float), list.place());
  const std::vector<size_t> extents = {size[2], size[1], size[0], 3};
  const Transform to_world = box_of(definition).to_world;
  auto medium = described("medium", "heterogeneous", list.place());
  set(*medium, "scale", std::max(list.number("scale", 1), 0.0));
  hold(*medium, "sigma_t", grid_volume(definition, extents, std::move(extinctions), to_world));
  hold(*medium, "albedo", grid_volume(definition, extents, std::move(albedos), to_world));
  return with_phase(medium, definition);
}

}  // namespace kaustik::pbrt
