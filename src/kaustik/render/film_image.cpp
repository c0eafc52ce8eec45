// The image of a film.
#include <fmt/format.h>

#include <optional>

#include "kaustik/base/parallel.h"
#include "kaustik/image/photometry.h"
#include "kaustik/render/film.h"
#include "kaustik/render/film_errors.h"

namespace kaustik {
namespace {

constexpr size_t lanes = FilmNumbers::lanes;

/// The sums of one pixel and what they tell.
class PixelSums {
 public:
  PixelSums(const Film& film, const Fixed* sums, double passes)
      : film_(film), numbers_(film.numbers()), sums_(sums), passes_(passes) {}

  double sum(size_t number) const { return double_from(sums_[number]); }
  double total(size_t lane) const {
    Fixed total = 0;
    for (size_t c = 0; c < (film_.layers().in_images ? component_count : 1); ++c)
      add_to(total, sums_[numbers_.radiance + c * lanes + lane]);
    return double_from(total);
  }
  Spectrum mean() const {
    Spectrum result;
    for (size_t lane = 0; lane < lanes; ++lane) result.set(int(lane), float(total(lane) / passes_));
    return result;
  }
  Spectrum mean(Component component) const {
    Spectrum result;
    for (size_t lane = 0; lane < lanes; ++lane)
      result.set(int(lane),
                 float(sum(numbers_.radiance + size_t(component) * lanes + lane) / passes_));
    return result;
  }
  Spectrum mean_emission() const {
    Spectrum result;
    for (size_t lane = 0; lane < lanes; ++lane)
      result.set(int(lane), float(sum(numbers_.emission + lane) / passes_));
    return result;
  }
  float mean_lamps() const { return float(sum(numbers_.lamps) / passes_); }
  float mean_first_hit(size_t lane) const {
    return float(sum(numbers_.first_hit + lane) / passes_);
  }
  ChannelSums channels() const {
    ChannelSums result;
    for (size_t lane = 0; lane < lanes; ++lane) {
      result.totals[lane] = total(lane);
      result.squares[lane] = sum(numbers_.squares + lane);
    }
    result.luminance_squares = sum(numbers_.luminance_squares);
    return result;
  }
  /// The mean luminance over `passes` of odd replicates.
  double odd_luminance(Component component, double passes) const {
    return odd_sum(component) / passes;
  }
  /// Standard errors of the kinds of light, over samples.
  std::array<double, noise_kinds> noise() const;

 private:
  double odd_sum(Component component) const;

  const Film& film_;
  const FilmNumbers& numbers_;
  const Fixed* sums_;
  double passes_;
};

double PixelSums::odd_sum(Component component) const {
  double rest = 0;
  for (size_t r = 1; r < replicate_count; r += 2) rest += sum(numbers_.replicate_luminances + r);
  for (size_t i = 0; i < halved_components().size(); ++i) {
    const double of_component = sum(numbers_.odd_luminances + i);
    if (halved_components()[i] == component) return of_component;
    rest -= of_component;
  }
  return rest;
}

std::array<double, noise_kinds> PixelSums::noise() const {
  std::array<double, noise_kinds> result{};
  // Variance of the mean of all passes, relative to that of a sample; 1/n if all are alike.
  const double share = sum(numbers_.inverse_samples) / sqr(passes_);
  std::array<Spectrum, component_count> means;
  for (int c = 0; c < component_count; ++c) means[size_t(c)] = mean(Component(c));
  const std::array<float, noise_kinds> mean = by_noise_kind(means);
  for (size_t k = 0; k < noise_kinds; ++k) {
    const double square = sum(numbers_.sample_squares + k) / passes_;
    const double spread = std::max(0.0, square - double(sqr(mean[k])));
    result[k] = std::sqrt(spread * share / std::max(share, 1 - share));
  }
  return result;
}

}  // namespace

std::vector<std::string> Film::channel_names(bool with_layers) const {
  std::vector<std::string> names = {"R", "G", "B"};
  if (!with_layers) {
    if (layers_.components.has(Component::emission))
      names.insert(names.end(), {"emission.R", "emission.G", "emission.B", "emission.A"});
    return names;
  }
  for (int c = 0; c < component_count; ++c)
    for (const char* lane : {"R", "G", "B"})
      if (layers_.components.has(Component(c)))
        names.push_back(fmt::format("{}.{}", component_names[size_t(c)], lane));
  for (const char* name : {"albedo.R", "albedo.G", "albedo.B", "N.X", "N.Y", "N.Z", "depth.Z",
                           "emission.A", "error.R", "error.G", "error.B"})
    names.emplace_back(name);
  if (layers_.bias) names.insert(names.end(), {"bias.R", "bias.G", "bias.B"});
  if (knows_noise()) names.insert(names.end(), {"noise.scattered", "noise.mirrored"});
  if (knows_halves()) {
    for (int c = 0; c < component_count; ++c)
      if (layers_.components.has(Component(c)))
        names.push_back(fmt::format("odd.{}", component_names[size_t(c)]));
    names.emplace_back("odd.share");
  }
  return names;
}

bool Film::knows_halves() const {
  const PassCounts counts(passes_);
  return layers_.holds_halves() && counts.of_half(0) > 0 && counts.of_half(1) > 0;
}

Image Film::image(bool with_layers) const {
  with_layers = with_layers && layers_.in_images;
  Image image(size_.x, size_.y, channel_names(with_layers));
  if (passes_.empty()) return image;
  if (!regions_.empty()) image.set_metadata(regions_key, text_of(regions_));
  const FilmParts parts(*this);
  std::optional<FilmErrors> errors;
  if (with_layers) errors.emplace(*this).prepare_pixels();
  const bool has_halves = knows_halves();
  const auto put = [&](int x, int y, const PixelSums& sums) {
    int channel = 0;
    const auto add = [&](float value) { image.at(x, y, channel++) = value; };
    const auto add_rgb = [&](const auto& rgb) {
      for (int lane = 0; lane < int(lanes); ++lane) add(rgb[lane]);
    };
    add_rgb(sums.mean());
    if (!with_layers) {
      if (!layers_.components.has(Component::emission)) return;
      add_rgb(sums.mean_emission());
      return add(sums.mean_lamps());
    }
    for (int c = 0; c < component_count; ++c)
      if (layers_.components.has(Component(c))) add_rgb(sums.mean(Component(c)));
    for (size_t k = 0; k < FilmNumbers::first_hit_lanes; ++k) add(sums.mean_first_hit(k));
    const size_t pixel = size_t(y) * size_t(size_.x) + size_t(x);
    add_rgb(errors->of_pixel(pixel, sums.channels()));
    if (layers_.bias) add_rgb(errors->mean_bias(pixel));
    if (knows_noise())
      for (const double deviation : sums.noise()) add(float(deviation));
    if (!has_halves) return;
    const double odd = parts.of_pixel(pixel).of_half(1);
    for (int c = 0; c < component_count; ++c)
      if (layers_.components.has(Component(c))) add(float(sums.odd_luminance(Component(c), odd)));
    add(float(odd / parts.of_pixel(pixel).count()));
  };
  parallel_blocks(tiles_.count(), 1, [&](size_t tile, size_t, size_t) {
    std::vector<Fixed> sums;
    read(tile, sums);
    tiles_.for_pixels_of(tile, [&](int x, int y, size_t place) {
      const size_t pixel = size_t(y) * size_t(size_.x) + size_t(x);
      put(x, y,
          PixelSums(*this, sums.data() + place * numbers_.count, parts.of_pixel(pixel).count()));
    });
  });
  return image;
}

}  // namespace kaustik
