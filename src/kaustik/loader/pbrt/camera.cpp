#include "kaustik/loader/pbrt/camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "kaustik/base/number_list.h"
#include "kaustik/loader/near_names.h"
#include "kaustik/loader/object_parts.h"

namespace kaustik::pbrt {
namespace {

/// The part of the plane that the picture shows: x from left to right, y from below to above.
struct Window {
  double x0 = -1, x1 = 1, y0 = -1, y1 = 1;
  double width() const { return x1 - x0; }
  double height() const { return y1 - y0; }
  bool is_centred() const { return x0 == -x1 && y0 == -y1; }
};

/// A picture of any shape shows at least from −1 to 1 along its shorter side.
Window window_of(const ViewTools& tools, const ParameterList& list, const PictureSize& size) {
  const double frame = list.number("frameaspectratio", size.aspect());
  Window window;
  if (frame > 1)
    window.x0 = -frame, window.x1 = frame;
  else
    window.y0 = -1 / frame, window.y1 = 1 / frame;
  const std::vector<double> given = list.numbers("screenwindow");
  if (given.size() == 4) window = {given[0], given[1], given[2], given[3]};
  if (!(window.width() > 0 && window.height() > 0))
    throw Error(ErrorKind::input, "the camera's window has no area",
                "let its numbers ascend: x0 x1 y0 y1", list.place_of("screenwindow"));
  const double aspect = window.width() / window.height();
  if (std::fabs(aspect - size.aspect()) > 1e-3 * aspect) {
    tools.deviations.approximated(
        "camera", "its pixels are squares: the window's height follows its width", list.place());
    const double middle = 0.5 * (window.y0 + window.y1);
    const double half = 0.5 * window.width() / size.aspect();
    window.y0 = middle - half, window.y1 = middle + half;
  }
  return window;
}

/// From Kaustik's camera, whose +x is to the left, to the world. Throws Error(input).
Transform world_from_camera(const ViewSettings& settings) {
  const Transform& camera = settings.camera_from_world;
  if (camera.dimensions() < 3)
    throw Error(ErrorKind::input, "the camera's transform is singular",
                "leave out factors of 0 before Camera", settings.place);
  return camera.inverse() * Transform::scale({-1, 1, 1});
}

std::shared_ptr<Object> make_straight(const ViewTools& tools, const ParameterList& list,
                                      const PictureSize& size, double radius, double distance,
                                      double fov_degrees) {
  auto sensor = described("sensor", radius > 0 ? "thinlens" : "perspective", list.place());
  const Window window = window_of(tools, list, size);
  const double half = std::tan(0.5 * fov_degrees * std::numbers::pi / 180);
  const bool is_usual =
      window.is_centred() && std::fabs(std::min(window.width(), window.height()) - 2) < 1e-6;
  if (is_usual) {
    set(*sensor, "fov", fov_degrees);
    set(*sensor, "fov_axis", std::string("smaller"));
  } else {
    const double half_width = 0.5 * window.width() * half;
    set(*sensor, "fov", 2 * std::atan(half_width) * 180 / std::numbers::pi);
    set(*sensor, "fov_axis", std::string("x"));
    if (!window.is_centred()) {
      set(*sensor, "principal_point_offset_x",
          std::clamp(0.5 * (window.x0 + window.x1) / window.width(), -100.0, 100.0));
      set(*sensor, "principal_point_offset_y",
          std::clamp(-0.5 * (window.y0 + window.y1) / window.height(), -100.0, 100.0));
    }
  }
  if (radius > 0) {
    set(*sensor, "aperture_radius", radius);
    set(*sensor, "focus_distance", std::clamp(distance, 1e-6, 1e12));
  }
  return sensor;
}

double fov_of(const ParameterList& list) {
  const double fov = list.number("fov", 90);
  const auto half = list.number("halffov");
  const double given = half ? 2 * *half : fov;
  if (given > 0 && given < 180) return std::clamp(given, 1e-4, 179.9);
  throw Error(ErrorKind::input, fmt::format("a field of view of {} degrees", given),
              "give one between 0 and 180", list.place_of("fov"));
}

std::shared_ptr<Object> make_perspective(const ViewTools& tools, const ParameterList& list,
                                         const PictureSize& size) {
  return make_straight(tools, list, size, list.number("lensradius", 0),
                       list.number("focaldistance", 1e6), fov_of(list));
}

std::shared_ptr<Object> make_orthographic(const ViewTools& tools, const ParameterList& list,
                                          const PictureSize& size, Transform& to_world) {
  const double radius = list.number("lensradius", 0);
  auto sensor = described("sensor", radius > 0 ? "telecentric" : "orthographic", list.place());
  const Window window = window_of(tools, list, size);
  const double half = 0.5 * window.width();
  to_world =
      to_world *
      Transform::translate({-0.5 * (window.x0 + window.x1), 0.5 * (window.y0 + window.y1), 0}) *
      Transform::scale({half, half, 1});
  if (radius > 0) {
    set(*sensor, "aperture_radius", radius);
    set(*sensor, "focus_distance", std::clamp(list.number("focaldistance", 1e6), 1e-6, 1e12));
  }
  return sensor;
}

std::shared_ptr<Object> make_spherical(const ViewTools& tools, const ParameterList& list,
                                       bool is_old, Transform& to_world) {
  auto sensor = described("sensor", "spherical", list.place());
  if (!is_old && list.text("mapping", "equalarea") != "equirectangular")
    tools.deviations.approximated(
        "camera", "directions lie by longitude and latitude, not in squares of equal area",
        list.place());
  // pbrt's middle looks along −x of its camera, with +y up and +z in the left half.
  const double rows[4][4] = {{0, 0, -1, 0}, {0, 1, 0, 0}, {1, 0, 0, 0}, {0, 0, 0, 1}};
  to_world = to_world * Transform::scale({-1, 1, 1}) * Transform(rows);
  return sensor;
}

std::shared_ptr<Object> make_realistic(const ViewTools& tools, const ParameterList& list,
                                       const ViewSettings& settings, const PictureSize& size) {
  const std::string name = list.text("lensfile");
  const double focus = list.number("focusdistance", 10);
  const double stop = list.number("aperturediameter", 1) * 1e-3;
  list.accept({"aperture", "simpleweighting"});
  ThinLens lens;
  constexpr size_t most_bytes = 1 << 20;
  const auto path = tools.files.find(name, list.place());
  std::optional<ThinLens> read;
  if (path) {
    const std::vector<uint8_t> bytes = tools.files.bytes_of(*path, most_bytes, list.place());
    std::string text;
    bool is_comment = false;
    for (const uint8_t byte : bytes) {
      if (byte == '#') is_comment = true;
      if (byte == '\n') is_comment = false;
      text += is_comment ? ' ' : char(byte);
    }
    read = thin_lens_of(parse_number_list(text).numbers);
  }
  if (read)
    lens = *read;
  else
    tools.deviations.missing("camera",
                             fmt::format("lens {} is not there: it is one of 50 mm", shown(name)),
                             list.place_of("lensfile"), where_files_lie);
  tools.deviations.approximated(
      "camera", fmt::format("its lens is a thin one of {:.4g} mm", lens.focal_length * 1e3),
      list.place());
  const double diagonal =
      settings.film ? settings.film->parameters.number("diagonal", 35) * 1e-3 : 0.035;
  // Sharp at that distance, the film lies a little behind the focus.
  const double image =
      focus > lens.focal_length ? 1 / (1 / lens.focal_length - 1 / focus) : lens.focal_length;
  const double shorter = diagonal * std::min(1.0, size.aspect()) / std::hypot(size.aspect(), 1.0);
  const double fov = 2 * std::atan(0.5 * shorter / image) * 180 / std::numbers::pi;
  const double radius = 0.5 * std::min(stop > 0 ? stop : lens.aperture, lens.aperture);
  return make_straight(tools, list, size, radius, focus, std::clamp(fov, 1e-3, 179.0));
}

}  // namespace

PictureSize picture_size(const ViewSettings& settings) {
  PictureSize size;
  if (!settings.film) return size;
  const ParameterList& list = settings.film->parameters;
  size.width = std::clamp(list.integer("xresolution", size.width), 1, 1 << 20);
  size.height = std::clamp(list.integer("yresolution", size.height), 1, 1 << 20);
  return size;
}

std::optional<ThinLens> thin_lens_of(const std::vector<double>& table) {
  if (table.size() < 8 || table.size() % 4 != 0) return std::nullopt;
  // A ray parallel to the axis at height 1, from the scene's side.
  double height = 1, slope = 0, index = 1, stop = 0;
  for (size_t i = 0; i < table.size(); i += 4) {
    const double radius = table[i], thickness = table[i + 1], diameter = table[i + 3];
    const double next = table[i + 2] == 0 ? 1 : table[i + 2];
    if (radius == 0) {
      if (height > 0) stop = diameter / height;  // seen from the front
    } else {
      slope = (index * slope - height * (next - index) / radius) / next;
      index = next;
    }
    if (i + 4 < table.size()) height += slope * thickness;
  }
  if (!(slope < 0)) return std::nullopt;
  const double focal_length = -1e-3 / slope;
  if (!(focal_length > 1e-4 && focal_length < 10)) return std::nullopt;
  return ThinLens{focal_length, stop > 0 ? stop * 1e-3 : focal_length / 4};
}

namespace {

/// With as many samples as pbrt takes: where no sampler is named 16, of Sobol's points.
std::shared_ptr<Object> make_sampler(const ViewSettings& settings) {
  static const Setting usual{"zsobol", ParameterList()};
  const Setting& sampler = settings.sampler ? *settings.sampler : usual;
  const ParameterList& list = sampler.parameters;
  const int of_grid = std::clamp(list.integer("xsamples", 4), 1, 1 << 12) *
                      std::clamp(list.integer("ysamples", 4), 1, 1 << 12);
  const bool is_random = sampler.type == "independent" || sampler.type == "random";
  const int usual_count = sampler.type == "stratified" ? of_grid : is_random ? 4 : 16;
  const int count = list.integer("pixelsamples", usual_count);
  auto made =
      described("sampler", "independent", list.place().file ? list.place() : settings.place);
  set(*made, "sample_count", int64_t{std::clamp(count, 1, 1 << 24)});
  return made;
}

}  // namespace

std::shared_ptr<Object> make_sensor(const ViewTools& tools, const ViewSettings& settings) {
  static const Setting usual{"perspective", ParameterList()};
  const Setting& camera = settings.camera ? *settings.camera : usual;
  const ParameterList& list = camera.parameters;
  const PictureSize size = picture_size(settings);
  Transform to_world = world_from_camera(settings);
  std::shared_ptr<Object> sensor;
  list.accept({"shutteropen", "shutterclose"});
  if (camera.type == "orthographic")
    sensor = make_orthographic(tools, list, size, to_world);
  else if (camera.type == "spherical" || camera.type == "environment")
    sensor = make_spherical(tools, list, camera.type == "environment", to_world);
  else if (camera.type == "realistic")
    sensor = make_realistic(tools, list, settings, size);
  else
    sensor = make_perspective(tools, list, size);
  if (!sensor->place.file) sensor->place = settings.place;
  // The lens is measured in the camera's own space.
  const double unit = std::cbrt(std::fabs(settings.camera_from_world.inverse().determinant3()));
  for (const char* const name : {"aperture_radius", "focus_distance"})
    if (Property* length = find_property(*sensor, name)) multiply_value(length->value, unit);
  if (camera.type != "perspective" && sensor->type == "perspective" && camera.type != "realistic")
    tools.deviations.approximated(
        "camera",
        fmt::format("there is no camera {}: it is one of perspective", shown(camera.type)),
        list.place(),
        did_you_mean(camera.type,
                     {"perspective", "orthographic", "spherical", "environment", "realistic"}));
  set(*sensor, "to_world", to_world);
  list.tell_unused("camera", tools.deviations);
  hold(*sensor, "", make_film(tools, settings));
  hold(*sensor, "", make_sampler(settings));
  return sensor;
}

}  // namespace kaustik::pbrt
