#include "kaustik/render/film_memory.h"

#include <fmt/format.h>

#include <algorithm>

#include "kaustik/base/memory.h"

namespace kaustik {
namespace {

// Bytes of one number of a pixel, as they were measured in the scene that ships and takes most,
// after 64 passes (64 × 64 pixels, memory_tool: larger pictures take less): sums of floats, of
// their squares, and of the luminances of a sixteenth of the passes. Of the six components five are
// there.
constexpr double of_sum = 5.5, of_square = 10.5, of_replicate = 4.75;
constexpr double components_there = 5;
/// What the pixels of a tile share: headers, pointers and what the allocator adds.
constexpr double of_tile = 2;
/// Exact sums of a lane of splats, and how many components they come to.
constexpr double of_splat_lane = 12, components_of_splats = 4;
/// Of errors: luminances, their variances and those of the pixels around; with bias, its sums and
/// their squares.
constexpr double of_errors = 4 * sizeof(double), of_bias_errors = 76;

constexpr double lanes_of_sum = FilmNumbers::lanes;

double count_of(ComponentSet components) {
  double count = 0;
  for (int c = 0; c < component_count; ++c) count += components.has(Component(c)) ? 1 : 0;
  return count;
}

}  // namespace

double FilmMemory::peak() const { return film + std::max({pass + splats, errors + image}); }

FilmMemory expected_film_memory(const FilmLayers& layers, bool splats) {
  const double components = std::min(components_there, count_of(layers.components));
  const double bias = layers.bias ? bias_halves * lanes_of_sum : 0;
  FilmMemory memory;
  memory.film = of_tile + of_replicate * replicate_count + of_sum * bias;
  double channels = lanes_of_sum;
  if (layers.in_images) {
    memory.film +=
        of_sum * (lanes_of_sum * components + FilmNumbers::first_hit_lanes + noise_kinds + 1) +
        of_square * (lanes_of_sum + 1);
    channels += lanes_of_sum * count_of(layers.components) + FilmNumbers::first_hit_lanes +
                lanes_of_sum + (layers.bias ? lanes_of_sum : 0) + noise_kinds;
  } else {
    memory.film += of_sum * lanes_of_sum;
  }
  const double numbers = lanes_of_sum * components + FilmNumbers::first_hit_lanes + noise_kinds +
                         (layers.bias ? lanes_of_sum : 0);
  memory.pass = of_tile + sizeof(float) * numbers;
  // Tiles that are finished hold no splats any more, others no pass yet.
  if (splats)
    memory.splats =
        std::max(0.0, of_splat_lane * lanes_of_sum *
                              std::min(components_of_splats, count_of(layers.components)) -
                          memory.pass);
  memory.errors = of_errors + (layers.bias ? of_bias_errors : 0);
  memory.image = sizeof(float) * channels;
  return memory;
}

void check_film_memory(const FilmSettings& settings, const FilmLayers& layers, bool splats) {
  const Vec2i size = settings.crop_size;
  // Tiles are whole.
  const double pixels = double(PictureTiles(size).count()) * double(PictureTiles::pixels);
  const double bytes = expected_film_memory(layers, splats).peak() * pixels;
  const auto there = double(physical_memory_bytes());
  if (int64_t(size.x) * size.y > max_image_pixels)
    throw Error(ErrorKind::input,
                fmt::format("a picture of {} × {} pixels is too large: at most {} are possible",
                            size.x, size.y, max_image_pixels),
                "choose a smaller width and height, or render it in parts by the film's crop "
                "window: kaustik stitch",
                settings.place);
  if (bytes <= there) return;
  throw Error(ErrorKind::input,
              fmt::format("a picture of {} × {} pixels is too large here: it needs about {:.1f} "
                          "GB, and this machine has {:.1f} GB",
                          size.x, size.y, bytes / 1e9, there / 1e9),
              fmt::format("choose a smaller width and height, {}or render it in parts by the "
                          "film's crop window: kaustik stitch",
                          layers.in_images ? "leave out the layers (film.layers=none), " : ""),
              settings.place);
}

}  // namespace kaustik
