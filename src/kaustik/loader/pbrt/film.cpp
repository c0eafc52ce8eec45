// The film: size, crop window, filter, exposure; and the integrator.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kaustik/loader/near_names.h"
#include "kaustik/loader/pbrt/camera.h"

namespace kaustik::pbrt {
namespace {

std::shared_ptr<Object> make_filter(const ViewTools& tools, const ViewSettings& settings) {
  static const Setting usual{"gaussian", ParameterList()};
  const Setting& filter = settings.filter ? *settings.filter : usual;
  const ParameterList& list = filter.parameters;
  const Place& place = list.place().file ? list.place() : settings.place;
  const auto radius = [&](double otherwise) {
    // v3 has widths.
    const double x = list.number("xradius", list.number("xwidth", otherwise));
    const double y = list.number("yradius", list.number("ywidth", otherwise));
    return std::clamp(0.5 * (x + y), 0.01, 16.0);
  };
  std::shared_ptr<Object> made;
  if (filter.type == "box" || filter.type == "triangle") {
    const bool is_box = filter.type == "box";
    made = described("rfilter", is_box ? "box" : "tent", place);
    set(*made, "radius", radius(is_box ? 0.5 : 2));
  } else if (filter.type == "mitchell") {
    made = described("rfilter", "mitchell", place);
    for (const char* const name : {"B", "C"})
      if (const auto number = list.number(name)) set(*made, name, std::clamp(*number, 0.0, 1.0));
    if (std::fabs(radius(2) - 2) > 1e-3)
      tools.deviations.approximated("pixel filter", "it is two pixels wide", place);
  } else if (filter.type == "sinc") {
    made = described("rfilter", "lanczos", place);
    set(*made, "lobes", int64_t{std::lround(std::clamp(list.number("tau", 3), 1.0, 10.0))});
    radius(4);
  } else {
    made = described("rfilter", "gaussian", place);
    const auto alpha = list.number("alpha");
    const double sigma =
        list.number("sigma", alpha && *alpha > 0 ? 1 / std::sqrt(2 * *alpha) : 0.5);
    set(*made, "stddev", std::clamp(sigma, 0.01, 4.0));
    radius(1.5);
    if (filter.type != "gaussian")
      tools.deviations.approximated(
          "pixel filter",
          fmt::format("there is no filter {}: it is 'gaussian'", shown(filter.type)), place,
          did_you_mean(filter.type, {"box", "gaussian", "mitchell", "sinc", "triangle"}));
  }
  list.tell_unused("pixel filter", tools.deviations);
  return made;
}

/// Pixels from … to, of so many.
struct PixelRange {
  int begin = 0, end = 0;
};

PixelRange cropped(double from, double to, int size) {
  const auto pixel = [&](double share) {
    return int(std::ceil(std::clamp(share, 0.0, 1.0) * size));
  };
  return {std::min(pixel(from), size - 1), pixel(to)};
}

void set_crop(Object& film, const ParameterList& list, const PictureSize& size) {
  PixelRange x{0, size.width}, y{0, size.height};
  const std::vector<double> shares = list.numbers("cropwindow");
  const std::vector<double> pixels = list.numbers("pixelbounds");
  if (pixels.size() == 4) {
    const auto within = [](double a, int low, int high) {
      return int(std::clamp(a, double(low), double(high)));
    };
    x = {within(pixels[0], 0, size.width - 1), within(pixels[1], 0, size.width)};
    y = {within(pixels[2], 0, size.height - 1), within(pixels[3], 0, size.height)};
  } else if (shares.size() == 4) {
    x = cropped(shares[0], shares[1], size.width);
    y = cropped(shares[2], shares[3], size.height);
  } else {
    return;
  }
  set(film, "crop_offset_x", int64_t{x.begin});
  set(film, "crop_offset_y", int64_t{y.begin});
  set(film, "crop_width", int64_t{std::max(1, x.end - x.begin)});
  set(film, "crop_height", int64_t{std::max(1, y.end - y.begin)});
}

/// Seconds that the shutter is open; of pbrt-v3, whose film is an image, they change no brightness.
double exposure_seconds(const ViewTools& tools, const ViewSettings& settings) {
  if (!settings.camera || (settings.film && is_old_film(settings.film->type))) return 1;
  const ParameterList& camera = settings.camera->parameters;
  const double seconds = camera.number("shutterclose", 1) - camera.number("shutteropen", 0);
  if (seconds > 0) return seconds;
  tools.deviations.approximated("camera", "its shutter never opens: it is open for a second",
                                camera.place_of("shutterclose"));
  return 1;
}

/// pbrt multiplies its picture by the shutter's time and the film's sensitivity (v3: by `scale`).
void set_exposure(Object& made, const ViewTools& tools, const ViewSettings& settings,
                  const ParameterList& film) {
  constexpr double least = 1e-4, most = 1e6;
  const double wanted =
      exposure_seconds(tools, settings) * film.number("iso", 100) / 100 * film.number("scale", 1);
  if (wanted == 1) return;
  const double ratio = std::clamp(wanted, least, most);
  set(made, "iso", 100 * ratio);
  tools.deviations.approximated(
      "film",
      wanted == ratio
          ? fmt::format("pictures for displays are exposed {:.4g} times; files of light are not",
                        ratio)
          : fmt::format("it is exposed {:.4g} times, not {:.4g} times", ratio, wanted),
      film.place().file ? film.place() : settings.place);
}

}  // namespace

std::shared_ptr<Object> make_film(const ViewTools& tools, const ViewSettings& settings) {
  static const Setting usual{"rgb", ParameterList()};
  const Setting& film = settings.film ? *settings.film : usual;
  const ParameterList& list = film.parameters;
  const Place& place = list.place().file ? list.place() : settings.place;
  auto made = described("film", "hdrfilm", place);
  const PictureSize size = picture_size(settings);
  set(*made, "width", int64_t{size.width});
  set(*made, "height", int64_t{size.height});
  set_crop(*made, list, size);
  set_exposure(*made, tools, settings, list);
  list.accept({"filename", "diagonal", "savefp16", "maxsampleluminance", "coordinatesystem"});
  if (const std::string sensor = list.text("sensor", "cie1931"); sensor != "cie1931")
    tools.deviations.approximated(
        "film", fmt::format("it sees as an eye does, not as the sensor {}", shown(sensor)),
        list.place_of("sensor"));
  if (list.number("whitebalance", 0) != 0)
    tools.deviations.ignored("film", "white balance has no effect", list.place_of("whitebalance"));
  if (list.has("maxcomponentvalue"))
    tools.deviations.ignored("film", "bright samples are not cut by 'maxcomponentvalue'",
                             list.place_of("maxcomponentvalue"));
  if (film.type == "spectral")
    tools.deviations.approximated("film", "the picture has colours, not bands of wavelengths",
                                  place);
  list.tell_unused("film", tools.deviations);
  hold(*made, "", make_filter(tools, settings));
  return made;
}

std::shared_ptr<Object> make_integrator(const ViewTools& tools, const ViewSettings& settings) {
  static const Setting usual{"volpath", ParameterList()};
  const Setting& integrator = settings.integrator ? *settings.integrator : usual;
  const ParameterList& list = integrator.parameters;
  const Place& place = list.place().file ? list.place() : settings.place;
  const std::string& type = integrator.type;
  auto made = described("integrator", "auto", place);
  const bool is_picture_of_light = type != "ambientocclusion" && type != "function" &&
                                   type != "whitted" && type != "directlighting" && type != "ao";
  if (!is_picture_of_light)
    tools.deviations.approximated(
        "integrator", fmt::format("the picture shows all light, not what {} does", shown(type)),
        place);
  if (list.flag("regularize", false))
    tools.deviations.ignored("integrator", "surfaces keep their gloss: 'regularize' has no effect",
                             list.place_of("regularize"));
  for (const Parameter& parameter : list.all()) parameter.is_used = true;
  // pbrt counts bounces, Kaustik segments.
  const int bounces = list.integer("maxdepth", 5);
  if (is_picture_of_light) set(*made, "max_depth", int64_t{std::clamp(bounces, 0, 1'000'000) + 1});
  return made;
}

}  // namespace kaustik::pbrt
