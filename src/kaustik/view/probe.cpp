#include "kaustik/view/probe.h"

#include <fmt/format.h>

#include <cmath>

#include "kaustik/image/photometry.h"
#include "kaustik/live/watched.h"
#include "kaustik/render/film_errors.h"
#include "kaustik/transport/component.h"
#include "kaustik/view/request_error.h"

namespace kaustik::view {
namespace {

Json finite_or_null(double number) { return std::isfinite(number) ? Json(number) : Json(nullptr); }

Json json_of_color(const Vec3f& color) { return Json::array({color.x, color.y, color.z}); }

Json json_of(const ConfidenceInterval& interval) {
  if (!std::isfinite(interval.half_width)) return nullptr;
  return Json::array({interval.mean - interval.half_width, interval.mean + interval.half_width});
}

/// The mean over the passes of a number of a pixel.
float mean_number(const Film& film, size_t pixel, size_t number) {
  return float(double_from(film.sum(pixel, number)) / film.pass_count(pixel));
}

/// The same of three numbers.
Vec3f mean_of(const Film& film, size_t pixel, size_t first_number) {
  Vec3f mean;
  for (size_t lane = 0; lane < 3; ++lane)
    mean[int(lane)] = mean_number(film, pixel, first_number + lane);
  return mean;
}

Json layers_of_pixel(const Film& film, size_t pixel) {
  Json layers = Json::object();
  const FilmNumbers& numbers = film.numbers();
  if (!film.layers().in_images) return layers;
  for (size_t c = 0; c < component_count; ++c)
    if (film.layers().components.has(Component(c)))
      layers[std::string(component_names[c])] =
          json_of_color(mean_of(film, pixel, numbers.radiance + c * FilmNumbers::lanes));
  layers["albedo"] = json_of_color(mean_of(film, pixel, numbers.first_hit));
  layers["N"] = json_of_color(mean_of(film, pixel, numbers.first_hit + 3));
  layers["depth"] = Json::array({mean_number(film, pixel, numbers.first_hit + 6)});
  return layers;
}

Json pixel_of_picture(const Image& picture, int x, int y) {
  const RgbView view = rgb_view(picture);
  const Vec3f value = view[size_t(y) * size_t(picture.width()) + size_t(x)];
  return {{"x", x},
          {"y", y},
          {"value", json_of_color(value)},
          {"luminance", photopic(value)},
          {"standard_error", nullptr},
          {"interval", nullptr},
          {"bias", nullptr},
          {"layers", Json::object()},
          {"passes", 0}};
}

Json region_of_picture(const Image& picture, const PixelRegion& region) {
  const RgbView view = rgb_view(picture);
  double sum = 0;
  for (int y = region.y; y < region.y + region.height; ++y)
    for (int x = region.x; x < region.x + region.width; ++x)
      sum += double(photopic(view[size_t(y) * size_t(picture.width()) + size_t(x)]));
  const int64_t pixels = int64_t(region.width) * region.height;
  return {{"mean", sum / double(pixels)},
          {"standard_error", nullptr},
          {"interval", nullptr},
          {"pixels", pixels}};
}

void check_lies_in(const PixelRegion& region, int width, int height) {
  if (int64_t(region.x) + region.width > width || int64_t(region.y) + region.height > height)
    throw RequestError(400,
                       fmt::format("the picture has no such pixels: it is {} × {}", width, height),
                       "ask for pixels within it");
}

/// What the film tells, or else what the picture does that is shown.
template <typename OfFilm, typename OfPicture>
Json facts_of(const Watched& shown, const PixelRegion& region, const OfFilm& of_film,
              const OfPicture& of_picture) {
  Json facts;
  const bool has_film = shown.look_at_film([&](const Film& film) {
    check_lies_in(region, film.width(), film.height());
    facts = of_film(film);
  });
  if (has_film) return facts;
  const auto snapshot = shown.snapshot();
  if (!snapshot) throw RequestError(409, "there is no picture yet", "ask again in a moment");
  check_lies_in(region, snapshot->picture.width(), snapshot->picture.height());
  return of_picture(snapshot->picture);
}

}  // namespace

Json pixel_facts(const Film& film, int x, int y) {
  const size_t pixel = size_t(y) * size_t(film.width()) + size_t(x);
  const FilmErrors errors(film);
  Vec3f value;
  for (int lane = 0; lane < 3; ++lane)
    value[lane] = float(film.total(pixel, lane) / film.pass_count(pixel));
  Json facts = {{"x", x}, {"y", y}, {"value", json_of_color(value)}};
  facts["luminance"] = photopic(value);
  const KnownLuminance known = errors.known(pixel);
  facts["standard_error"] = finite_or_null(known.error());
  facts["interval"] = json_of(known.interval());
  facts["bias"] = film.holds_bias() ? json_of_color(errors.mean_bias(pixel)) : Json(nullptr);
  facts["layers"] = layers_of_pixel(film, pixel);
  facts["passes"] = film.pass_count(pixel);
  return facts;
}

Json region_facts(const Film& film, const PixelRegion& region) {
  const KnownLuminance known = FilmErrors(film).known(region);
  return {{"mean", known.mean},
          {"standard_error", finite_or_null(known.error())},
          {"interval", json_of(known.interval())},
          {"pixels", int64_t(region.width) * region.height}};
}

Json pixel_of(const Watched& shown, int x, int y) {
  return facts_of(
      shown, {x, y, 1, 1}, [&](const Film& film) { return pixel_facts(film, x, y); },
      [&](const Image& picture) { return pixel_of_picture(picture, x, y); });
}

Json region_of(const Watched& shown, const PixelRegion& region) {
  return facts_of(
      shown, region, [&](const Film& film) { return region_facts(film, region); },
      [&](const Image& picture) { return region_of_picture(picture, region); });
}

}  // namespace kaustik::view
