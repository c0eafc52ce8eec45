#include "kaustik/render/film.h"

#include <fmt/format.h>

#include <cassert>

#include "kaustik/base/parallel.h"
#include "kaustik/image/photometry.h"
#include "kaustik/render/film_errors.h"

namespace kaustik {
namespace {

constexpr size_t pixels_per_block = 4096;

Vec3f rgb_of(const Spectrum& radiance) { return {radiance[0], radiance[1], radiance[2]}; }

}  // namespace

std::array<float, noise_kinds> by_noise_kind(
    const std::array<Spectrum, component_count>& radiance) {
  const auto part = [&](Component c) { return radiance[size_t(c)]; };
  return {photopic(rgb_of(part(Component::direct) + part(Component::caustic) +
                          part(Component::indirect))),
          photopic(rgb_of(part(Component::specular)))};
}

void Film::check_size(const FilmSettings& settings, size_t numbers_per_pixel) {
  // The sums, the pass and the image that is written.
  const auto bytes_per_pixel =
      int64_t(sizeof(Fixed) * numbers_per_pixel + sizeof(PassPixel) +
              sizeof(float) * (3 * (component_count + 3) + first_hit_lanes_ + noise_kinds));
  const Vec2i size = settings.crop_size;
  try {
    check_image_size(size.x, size.y, bytes_per_pixel / int64_t(sizeof(float)));
  } catch (const Error&) {
    throw Error(
        ErrorKind::input,
        fmt::format("a picture of {} × {} pixels is too large here: it needs {:.1f} GB", size.x,
                    size.y, double(size.x) * double(size.y) * double(bytes_per_pixel) / 1e9),
        "choose a smaller width and height, or render it in parts by the film's crop window: "
        "kaustik stitch",
        settings.place);
  }
}

Film::Film(const FilmSettings& settings, const FilmLayers& layers)
    : Film(settings.crop_size, layers) {
  check_size(settings, numbers_per_pixel());
  numbers_.resize(pixel_count() * numbers_per_pixel());
}

void Film::add_pass(const std::vector<PassPixel>& pixels, uint32_t pass_index, uint32_t samples) {
  assert(pixels.size() == pixel_count() && !passes_.holds(pass_index));
  const size_t replicate = pass_index % replicate_count;
  const double luminance_sum =
      sum_over_blocks(pixels.size(), pixels_per_block, [&](size_t begin, size_t end) {
        double sum = 0;
        for (size_t i = begin; i < end; ++i) sum += add_pixel(i, pixels[i], replicate, samples);
        return sum;
      });
  add_to(mean_luminances_[replicate],
         fixed_from(luminance_sum / double(std::max<size_t>(1, pixels.size()))));
  passes_.add({pass_index, pass_index + 1});
  sample_count_ += samples;
}

void Film::add(const Film& other) {
  assert(is_like(other) && passes_.common(other.passes_).empty());
  parallel_blocks(numbers_.size(), pixels_per_block * numbers_per_pixel(),
                  [&](size_t begin, size_t end, size_t) {
                    for (size_t i = begin; i < end; ++i) add_to(numbers_[i], other.numbers_[i]);
                  });
  for (size_t r = 0; r < replicate_count; ++r)
    add_to(mean_luminances_[r], other.mean_luminances_[r]);
  passes_.add(other.passes_);
  sample_count_ += other.sample_count_;
}

double Film::add_pixel(size_t i, const PassPixel& pixel, size_t replicate, uint32_t samples) {
  double total[lanes_] = {};
  Fixed* sum = sums(i);
  for (int c = 0; c < component_count; ++c)
    for (int lane = 0; lane < lanes_; ++lane) {
      const double value = pixel.radiance[size_t(c)][lane];
      add_to(sum[radiance_ + size_t(c * lanes_ + lane)], fixed_from(value));
      total[lane] += value;
    }
  for (int lane = 0; lane < lanes_; ++lane)
    add_to(sum[squares_ + size_t(lane)], fixed_from(total[lane] * total[lane]));
  const FirstHit& hit = pixel.first_hit;
  const double first[first_hit_lanes_] = {hit.albedo[0], hit.albedo[1], hit.albedo[2], hit.normal.x,
                                          hit.normal.y,  hit.normal.z,  hit.depth};
  for (size_t k = 0; k < first_hit_lanes_; ++k) add_to(sum[first_hit_ + k], fixed_from(first[k]));
  for (size_t k = 0; k < noise_kinds; ++k)
    add_to(sum[sample_squares_ + k], fixed_from(double(pixel.squares[k])));
  add_to(sum[inverse_samples_],
         fixed_from(1 / double(pixel.samples > 0 ? pixel.samples : samples)));
  if (layers_.bias) {
    Fixed* bias = sum + bias_ + replicate % bias_halves * lanes_;
    for (int lane = 0; lane < lanes_; ++lane)
      add_to(bias[lane], fixed_from(double(pixel.bias[lane])));
  }
  const double luminance = photopic(Vec3f(float(total[0]), float(total[1]), float(total[2])));
  add_to(sum[luminance_squares_], fixed_from(luminance * luminance));
  add_to(sum[replicate_luminances_ + replicate], fixed_from(luminance));
  return luminance;
}

Spectrum Film::mean(size_t pixel, Component component) const {
  Spectrum result;
  for (int lane = 0; lane < lanes_; ++lane)
    result.set(
        lane, float(sum(pixel, radiance_ + size_t(int(component) * lanes_ + lane)) / pass_count()));
  return result;
}

double Film::total(size_t pixel, int lane) const {
  Fixed total = 0;
  for (int c = 0; c < component_count; ++c)
    add_to(total, sums(pixel)[radiance_ + size_t(c * lanes_ + lane)]);
  return double_from(total);
}

Spectrum Film::mean(size_t pixel) const {
  Spectrum result;
  for (int lane = 0; lane < lanes_; ++lane)
    result.set(lane, float(total(pixel, lane) / pass_count()));
  return result;
}

Vec3f Film::bias_sum(size_t pixel, size_t half) const {
  Vec3f result;
  for (int lane = 0; lane < lanes_; ++lane)
    result[lane] = float(sum(pixel, bias_ + half * lanes_ + size_t(lane)));
  return result;
}

Vec3f Film::mean_bias(size_t pixel) const {
  return (bias_sum(pixel, 0) + bias_sum(pixel, 1)) / float(pass_count());
}

std::array<double, noise_kinds> Film::noise(size_t pixel) const {
  std::array<double, noise_kinds> result{};
  const double passes = pass_count();
  // Variance of the mean of all passes, relative to that of a sample; 1/n if all are alike.
  const double share = sum(pixel, inverse_samples_) / sqr(passes);
  std::array<Spectrum, component_count> means;
  for (int c = 0; c < component_count; ++c) means[size_t(c)] = mean(pixel, Component(c));
  const std::array<float, noise_kinds> mean = by_noise_kind(means);
  for (size_t k = 0; k < noise_kinds; ++k) {
    const double square = sum(pixel, sample_squares_ + k) / passes;
    const double spread = std::max(0.0, square - double(sqr(mean[k])));
    result[k] = std::sqrt(spread * share / std::max(share, 1 - share));
  }
  return result;
}

Image Film::image() const {
  std::vector<std::string> names = {"R", "G", "B"};
  for (int c = 0; c < component_count; ++c)
    for (const char* lane : {"R", "G", "B"})
      if (layers_.components.has(Component(c)))
        names.push_back(fmt::format("{}.{}", component_names[size_t(c)], lane));
  for (const char* name : {"albedo.R", "albedo.G", "albedo.B", "N.X", "N.Y", "N.Z", "depth.Z",
                           "error.R", "error.G", "error.B"})
    names.emplace_back(name);
  if (layers_.bias) names.insert(names.end(), {"bias.R", "bias.G", "bias.B"});
  if (knows_noise()) names.insert(names.end(), {"noise.scattered", "noise.mirrored"});
  Image image(size_.x, size_.y, names);
  if (passes_.empty()) return image;
  const FilmErrors errors(*this);
  parallel_blocks(size_t(size_.y), 1, [&](size_t row, size_t, size_t) {
    for (int x = 0; x < size_.x; ++x) {
      int channel = 0;
      for (const float value : values(row * size_t(size_.x) + size_t(x), errors))
        image.at(x, int(row), channel++) = value;
    }
  });
  return image;
}

std::vector<float> Film::values(size_t pixel, const FilmErrors& errors) const {
  std::vector<float> result;
  const auto add_rgb = [&](const Spectrum& s) { result.insert(result.end(), {s[0], s[1], s[2]}); };
  const auto add_vector = [&](const Vec3f& v) { result.insert(result.end(), {v.x, v.y, v.z}); };
  add_rgb(mean(pixel));
  for (int c = 0; c < component_count; ++c)
    if (layers_.components.has(Component(c))) add_rgb(mean(pixel, Component(c)));
  for (size_t k = 0; k < first_hit_lanes_; ++k)
    result.push_back(float(sum(pixel, first_hit_ + k) / pass_count()));
  add_vector(errors.of_pixel(pixel));
  if (layers_.bias) add_vector(mean_bias(pixel));
  if (knows_noise())
    for (const double deviation : noise(pixel)) result.push_back(float(deviation));
  return result;
}

double Film::mean_error() const { return FilmErrors(*this).of_mean(); }

double Film::picture_error() const { return FilmErrors(*this).of_picture(); }

}  // namespace kaustik
