#include "kaustik/render/film.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "kaustik/base/parallel.h"
#include "kaustik/image/photometry.h"
#include "kaustik/render/film_errors.h"
#include "kaustik/render/film_memory.h"
#include "kaustik/render/film_parts.h"
#include "kaustik/render/rounded_line.h"

namespace kaustik {
namespace {

/// Of the means over the picture, which are added up in this order since there are films.
constexpr size_t pixels_per_block = 4096;
/// That one thread packs, one after the other, with the same buffers.
constexpr size_t tiles_per_block = 32;

constexpr size_t tile_pixels = PictureTiles::pixels;

}  // namespace

FilmNumbers::FilmNumbers(const FilmLayers& layers) {
  const auto next = [this](size_t numbers) {
    count += numbers;
    return count - numbers;
  };
  radiance = next(layers.in_images ? component_count * lanes : lanes);
  if (layers.in_images) {
    squares = next(lanes);
    first_hit = next(first_hit_lanes);
    emission = radiance + size_t(Component::emission) * lanes;
    lamps = first_hit + first_hit_lanes - 1;
    sample_squares = next(noise_kinds);
    inverse_samples = next(1);
    luminance_squares = next(1);
  } else {
    emission = next(lanes);
    lamps = next(1);
  }
  replicate_luminances = next(replicate_count);
  if (layers.bias) bias = next(bias_halves * lanes);
  if (layers.holds_halves()) odd_luminances = next(halved_components().size());
}

Film::Film(Vec2i size, const FilmLayers& layers)
    : size_(size), layers_(layers), numbers_(layers), tiles_(size) {}

Film::Film(const FilmSettings& settings, const FilmLayers& layers, bool splats)
    : Film(settings.crop_size, layers) {
  check_film_memory(settings, layers, splats);
  sums_.resize(tiles_.count());
}

/// A pass on its way to the film.
class Film::Addition {
 public:
  Addition(Film& film, const PassTiles& pass, size_t replicate, uint32_t samples)
      : film_(film), pass_(pass), replicate_(replicate), samples_(samples) {}

  /// Adds the pass's tile, and tells the luminances of its pixels.
  void add(size_t tile, TilePacker& packer, PassTiles::Line& luminances) {
    find_totals(tile);
    for (size_t i = 0; i < tile_pixels; ++i)
      luminances[i] =
          photopic(Vec3f(float(totals_[0][i]), float(totals_[1][i]), float(totals_[2][i])));
    rounded_luminances_ = luminances;
    round_line(rounded_luminances_, luminance_bits);
    packer.begin(film_.sums_[tile]);
    if (film_.layers_.in_images)
      add_layers(tile, packer);
    else
      add_picture(tile, packer);
    for (size_t r = 0; r < replicate_count; ++r) {
      if (r == replicate_)
        packer.add(rounded_luminances_);
      else
        packer.keep();
    }
    if (film_.layers_.bias) add_bias(tile, packer);
    if (film_.layers_.holds_halves()) add_halves(tile, packer);
    packer.end(film_.sums_[tile]);
  }

 private:
  using Totals = std::array<double, tile_pixels>;

  void find_totals(size_t tile) {
    for (size_t lane = 0; lane < FilmNumbers::lanes; ++lane) {
      totals_[lane].fill(0);
      if (!film_.layers_.in_images) exact_totals_[lane].fill(0);
      for (size_t c = 0; c < component_count; ++c) {
        const auto* line =
            pass_.read(tile, PassTiles::radiance + c * FilmNumbers::lanes + lane, uniform_);
        if (!line) continue;
        for (size_t i = 0; i < tile_pixels; ++i) totals_[lane][i] += double((*line)[i]);
        if (!film_.layers_.in_images)
          for (size_t i = 0; i < tile_pixels; ++i)
            add_to(exact_totals_[lane][i], fixed_from(double((*line)[i])));
      }
    }
  }

  void add_picture(size_t tile, TilePacker& packer) {
    for (const auto& sums : exact_totals_) packer.add(sums);
    constexpr size_t emission =
        PassTiles::radiance + size_t(Component::emission) * FilmNumbers::lanes;
    for (size_t lane = 0; lane < FilmNumbers::lanes; ++lane)
      add_line(tile, emission + lane, packer);
    add_line(tile, PassTiles::lamps, packer);
  }

  void add_layers(size_t tile, TilePacker& packer) {
    size_t line = PassTiles::radiance;
    for (; line < PassTiles::first_hit; ++line) add_line(tile, line, packer);
    for (const Totals& totals : totals_) add_squares(totals, packer);
    for (; line < PassTiles::squares; ++line) add_line(tile, line, packer);
    for (; line < PassTiles::bias; ++line) add_rounded(tile, line, sample_bits, packer);
    std::array<uint32_t, tile_pixels> samples;
    pass_.read_samples(tile, samples);
    for (size_t i = 0; i < tile_pixels; ++i)
      products_[i] = 1 / double(samples[i] > 0 ? samples[i] : samples_);
    round_line(products_, sample_bits);
    packer.add(products_);
    add_squares(rounded_luminances_, packer);
  }

  void add_bias(size_t tile, TilePacker& packer) {
    for (size_t half = 0; half < bias_halves; ++half)
      for (size_t lane = 0; lane < FilmNumbers::lanes; ++lane) {
        if (half == replicate_ % bias_halves)
          add_rounded(tile, PassTiles::bias + lane, bias_bits, packer);
        else
          packer.keep();
      }
  }

  void add_halves(size_t tile, TilePacker& packer) {
    for (const Component component : halved_components()) {
      if (replicate_ % 2 == 0 || !find_luminances(tile, component)) {
        packer.keep();
        continue;
      }
      round_line(rounded_, half_bits);
      packer.add(rounded_);
    }
  }

  /// Of one component, into `rounded_`; false: it is black all over the tile.
  bool find_luminances(size_t tile, Component component) {
    std::array<PassTiles::Line, FilmNumbers::lanes> uniform;
    std::array<const PassTiles::Line*, FilmNumbers::lanes> lines;
    bool is_black = true;
    for (size_t lane = 0; lane < lines.size(); ++lane) {
      const size_t line = PassTiles::radiance + size_t(component) * FilmNumbers::lanes + lane;
      lines[lane] = pass_.read(tile, line, uniform[lane]);
      is_black = is_black && !lines[lane];
      if (lines[lane]) continue;
      uniform[lane].fill(0);
      lines[lane] = &uniform[lane];
    }
    if (is_black) return false;
    for (size_t i = 0; i < tile_pixels; ++i) {
      const float luminance = photopic({(*lines[0])[i], (*lines[1])[i], (*lines[2])[i]});
      rounded_[i] = std::isfinite(luminance) ? luminance : 0;
    }
    return true;
  }

  void add_line(size_t tile, size_t line, TilePacker& packer) {
    if (const auto* values = pass_.read(tile, line, uniform_))
      packer.add(*values);
    else
      packer.keep();
  }

  void add_rounded(size_t tile, size_t line, int bits, TilePacker& packer) {
    const auto* values = pass_.read(tile, line, uniform_);
    if (!values) return packer.keep();
    rounded_ = *values;
    // Light near the end of the range of floats may have no luminance there: it tells of no error.
    for (float& value : rounded_)
      if (!std::isfinite(value)) value = 0;
    round_line(rounded_, bits);
    packer.add(rounded_);
  }

  template <typename Values>
  void add_squares(const Values& values, TilePacker& packer) {
    for (size_t i = 0; i < tile_pixels; ++i) products_[i] = double(values[i]) * double(values[i]);
    round_line(products_, square_bits);
    packer.add(products_);
  }

  Film& film_;
  const PassTiles& pass_;
  size_t replicate_;
  uint32_t samples_;
  PassTiles::Line uniform_, rounded_, rounded_luminances_;
  std::array<Totals, FilmNumbers::lanes> totals_;
  std::array<std::array<Fixed, tile_pixels>, FilmNumbers::lanes> exact_totals_;
  Totals products_;
};

void Film::add_pass(const PassTiles& pass, uint32_t pass_index, uint32_t samples) {
  assert(pass.tiles().count() == tiles_.count() && !passes_.holds(pass_index));
  const size_t replicate = pass_index % replicate_count;
  std::vector<float> luminances(pixel_count());
  parallel_blocks(tiles_.count(), tiles_per_block, [&](size_t begin, size_t end, size_t) {
    TilePacker packer(numbers_.count);
    const auto addition = std::make_unique<Addition>(*this, pass, replicate, samples);
    PassTiles::Line of_tile;
    for (size_t tile = begin; tile < end; ++tile) {
      addition->add(tile, packer, of_tile);
      tiles_.for_pixels_of(tile, [&](int x, int y, size_t place) {
        luminances[size_t(y) * size_t(size_.x) + size_t(x)] = of_tile[place];
      });
    }
  });
  const double luminance_sum =
      sum_over_blocks(luminances.size(), pixels_per_block, [&](size_t begin, size_t end) {
        double sum = 0;
        for (size_t i = begin; i < end; ++i) sum += double(luminances[i]);
        return sum;
      });
  add_to(mean_luminances_[replicate],
         fixed_from(luminance_sum / double(std::max<size_t>(1, luminances.size()))));
  passes_.add({pass_index, pass_index + 1});
  sample_count_ += samples;
}

void Film::add(const Film& other) {
  assert(is_like(other) && passes_.common(other.passes_).empty() &&
         twice_in_regions(other).empty());
  parallel_blocks(tiles_.count(), tiles_per_block, [&](size_t begin, size_t end, size_t) {
    TilePacker packer(numbers_.count);
    for (size_t tile = begin; tile < end; ++tile)
      packer.add_packed(sums_[tile], other.sums_[tile].packed());
  });
  for (size_t r = 0; r < replicate_count; ++r)
    add_to(mean_luminances_[r], other.mean_luminances_[r]);
  passes_.add(other.passes_);
  sample_count_ += other.sample_count_;
  for (const FilmRegion& region : other.regions_) add_region(region);
}

void Film::add_region(const FilmRegion& region) {
  const auto [at, is_there] = place_of(region.pixels);
  if (is_there)
    at->add(region);
  else
    regions_.insert(at, region);
}

size_t Film::bytes() const {
  size_t sum = sums_.capacity() * sizeof(PackedTile);
  for (const PackedTile& tile : sums_) sum += tile.bytes();
  for (const FilmRegion& region : regions_) sum += region.film.bytes();
  return sum;
}

double Film::total(size_t pixel, int lane) const {
  Fixed total = 0;
  for (size_t c = 0; c < (layers_.in_images ? component_count : 1); ++c)
    add_to(total, sum(pixel, numbers_.radiance + c * FilmNumbers::lanes + size_t(lane)));
  return double_from(total);
}

double Film::mean_error() const { return FilmErrors(*this).of_mean(); }

double Film::picture_error() const {
  // Else the sums that FilmErrors makes, over all pixels, would be for nothing.
  return FilmParts(*this).are_known() ? FilmErrors(*this).of_picture()
                                      : std::numeric_limits<double>::infinity();
}

}  // namespace kaustik
