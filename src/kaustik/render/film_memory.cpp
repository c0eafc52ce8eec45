#include "kaustik/render/film_memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "kaustik/base/memory.h"
#include "kaustik/render/rounded_line.h"

namespace kaustik {
namespace {

// A word of a sum has the significant bits of what is summed, those that sums of so many passes
// grow by, and those by which the numbers of a tile differ in size. That much and no more they may
// spread on average over a tile's pixels for the film to keep to these figures: bits beyond, which
// few have, are kept apart.
constexpr double bits_of_passes = 10;  ///< 1024
constexpr double bits_of_replicate_passes = bits_of_passes - 4, bits_of_half = bits_of_passes - 1;
static_assert(replicate_count == 16 && bias_halves == 2);
constexpr double float_bits = std::numeric_limits<float>::digits;
constexpr double spread_of_light = 24;  ///< of components of the light, exact
constexpr double spread_of_samples = 16, spread_of_surfaces = 8;
/// Of what is rounded to a common power of two, only what is larger than most.
constexpr double spread_of_rounded = 6;
/// The sign, what rounding may carry, and flags of what is kept apart.
constexpr double bits_beside = 3;

constexpr double bytes_of(double significant, double spread, double growth) {
  return (significant + spread + growth + bits_beside) / 8;
}
constexpr double of_light = bytes_of(float_bits, spread_of_light, bits_of_passes);
constexpr double of_surface = bytes_of(float_bits, spread_of_surfaces, bits_of_passes);
constexpr double of_square = bytes_of(square_bits + 1, 2 * spread_of_rounded, bits_of_passes);
constexpr double of_sample_square = bytes_of(sample_bits + 1, spread_of_samples, bits_of_passes);
constexpr double of_inverse_samples = bytes_of(sample_bits + 1, spread_of_rounded, bits_of_passes);
constexpr double of_replicate =
    bytes_of(luminance_bits + 1, spread_of_rounded, bits_of_replicate_passes);
constexpr double of_half = bytes_of(half_bits + 1, spread_of_rounded, bits_of_half);
constexpr double of_bias = bytes_of(bias_bits + 1, spread_of_rounded, bits_of_half);

/// What the pixels of a tile share: headers, pointers and what the allocator adds.
constexpr double of_tile = 2;
/// Exact sums of a lane of splats. One component is not splatted: what lamps send straight to the
/// camera. Integrators that do splat it have no camera samples, and so less of other numbers.
constexpr double of_splat_lane = 12, unsplatted_components = 1;
/// The luminance of a pixel while a pass is added to the film.
constexpr double of_luminance = sizeof(float);
/// Of errors: luminances, their variances and those of the pixels around.
constexpr double of_errors = 4 * sizeof(double);
/// With bias: its sums, means of halves, the light, and squares. What these are made from is held
/// for some rows alone; pictures that fill a machine have far more.
constexpr double of_bias_errors = 3 * 3 * sizeof(float) + sizeof(double) + (4 + 2) * sizeof(float);

constexpr double lanes_of_sum = FilmNumbers::lanes;

double count_of(ComponentSet components) {
  double count = 0;
  for (int c = 0; c < component_count; ++c) count += components.has(Component(c)) ? 1 : 0;
  return count;
}

/// Of the picture, or of a region: its tiles are whole.
double tiled_pixels(const Vec2i& size) {
  return double(PictureTiles(size).count()) * double(PictureTiles::pixels);
}

}  // namespace

double FilmMemory::peak() const { return std::max(rendering(), film + errors + image); }

FilmMemory expected_film_memory(const FilmLayers& layers, bool splats) {
  const double lanes_of_light = lanes_of_sum * count_of(layers.components);
  const double lanes_of_bias = layers.bias ? lanes_of_sum : 0;
  FilmMemory memory;
  memory.film = of_tile + of_replicate * replicate_count + of_bias * bias_halves * lanes_of_bias;
  if (layers.holds_halves())
    for (const Component component : halved_components())
      memory.film += layers.components.has(component) ? of_half : 0;
  double channels = lanes_of_sum;
  if (layers.in_images) {
    memory.film += of_light * lanes_of_light + of_surface * FilmNumbers::first_hit_lanes +
                   of_sample_square * noise_kinds + of_inverse_samples +
                   of_square * (lanes_of_sum + 1);
    channels +=
        lanes_of_light + FilmNumbers::first_hit_lanes + lanes_of_sum + lanes_of_bias + noise_kinds;
    if (layers.holds_halves()) channels += count_of(layers.components) + 1;
  } else {
    memory.film += of_light * lanes_of_sum;
    if (layers.components.has(Component::emission)) {
      memory.film += of_light * lanes_of_sum + of_surface;
      channels += lanes_of_sum + 1;
    }
  }
  const double numbers =
      lanes_of_light + FilmNumbers::first_hit_lanes + noise_kinds + lanes_of_bias + 1;
  memory.pass = of_tile + sizeof(float) * numbers + of_luminance;
  if (splats)
    memory.splats =
        of_tile + of_splat_lane * lanes_of_sum *
                      std::max(1.0, count_of(layers.components) - unsplatted_components);
  memory.errors = of_errors + (layers.bias ? of_bias_errors : 0);
  memory.image = sizeof(float) * channels;
  return memory;
}

void check_film_memory(const FilmSettings& settings, const FilmLayers& layers, bool splats) {
  const Vec2i size = settings.crop_size;
  const double bytes = expected_film_memory(layers, splats).peak() * tiled_pixels(size);
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

void check_region_memory(const FilmSettings& settings, const FilmLayers& layers, bool splats,
                         const std::vector<PixelRegion>& regions) {
  const FilmMemory memory = expected_film_memory(layers, splats);
  double bytes = memory.peak() * tiled_pixels(settings.crop_size);
  for (const PixelRegion& region : regions)
    bytes += memory.film * tiled_pixels({region.width, region.height});
  const auto there = double(physical_memory_bytes());
  if (bytes <= there) return;
  throw Error(ErrorKind::input,
              fmt::format("with regions that have passes of their own the picture would need about "
                          "{:.1f} GB, and this machine has {:.1f} GB",
                          bytes / 1e9, there / 1e9),
              "ask for a smaller region, or for more passes of one that is there");
}

}  // namespace kaustik
