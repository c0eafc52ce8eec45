#include "kaustik/render/film.h"

#include <fmt/format.h>

#include <numeric>

#include "kaustik/base/parallel.h"
#include "kaustik/base/statistics.h"
#include "kaustik/image/photometry.h"

namespace kaustik {
namespace {

constexpr size_t first_hit_lanes = 7;
constexpr size_t pixels_per_block = 4096;

/// Sum over the pixels, in parallel, of what `sum_of(begin, end)` returns for a block of them.
template <typename Value, typename SumOf>
Value sum_over_blocks(size_t pixels, const SumOf& sum_of) {
  std::vector<Value> sums((pixels + pixels_per_block - 1) / pixels_per_block);
  parallel_blocks(pixels, pixels_per_block, [&](size_t begin, size_t end, size_t block) {
    sums[block] = sum_of(begin, end);
  });
  return std::accumulate(sums.begin(), sums.end(), Value(0));
}

/// The sums, the pass and the image that is written.
constexpr int64_t film_bytes_per_pixel =
    sizeof(Fixed) * (3 * component_count + 3 + first_hit_lanes + noise_kinds) + sizeof(PassPixel) +
    sizeof(float) * (3 * (component_count + 2) + first_hit_lanes + noise_kinds);

void check_size(const FilmSettings& settings) {
  const Vec2i size = settings.crop_size;
  try {
    check_image_size(size.x, size.y, film_bytes_per_pixel / int64_t(sizeof(float)));
  } catch (const Error&) {
    throw Error(
        ErrorKind::input,
        fmt::format("a picture of {} × {} pixels is too large here: it needs {:.1f} GB", size.x,
                    size.y, double(size.x) * double(size.y) * double(film_bytes_per_pixel) / 1e9),
        "choose a smaller width and height, or render it in parts by the film's crop window",
        settings.place);
  }
}

Vec3f rgb_of(const Spectrum& radiance) { return {radiance[0], radiance[1], radiance[2]}; }

}  // namespace

std::array<float, noise_kinds> by_noise_kind(
    const std::array<Spectrum, component_count>& radiance) {
  const auto part = [&](Component c) { return radiance[size_t(c)]; };
  return {photopic(rgb_of(part(Component::direct) + part(Component::caustic) +
                          part(Component::indirect))),
          photopic(rgb_of(part(Component::specular)))};
}

Film::Film(const FilmSettings& settings, ComponentSet components)
    : size_(settings.crop_size), components_(components) {
  check_size(settings);
  const size_t pixels = size_t(size_.x) * size_t(size_.y);
  sums_.resize(pixels * component_count * lanes_);
  squares_.resize(pixels * lanes_);
  first_hits_.resize(pixels * first_hit_lanes);
  sample_squares_.resize(pixels * noise_kinds);
}

void Film::add_pass(const std::vector<PassPixel>& pixels, uint32_t pass_index, uint32_t samples) {
  const auto luminance_sum = sum_over_blocks<Fixed>(pixels.size(), [&](size_t begin, size_t end) {
    Fixed sum = 0;
    for (size_t i = begin; i < end; ++i) sum += fixed_from(add_pixel(i, pixels[i]));
    return sum;
  });
  const uint32_t replicate = pass_index % replicate_count;
  replicate_sums_[replicate] +=
      fixed_from(double_from(luminance_sum) / double(std::max<size_t>(1, pixels.size())));
  ++replicate_passes_[replicate];
  ++pass_count_;
  sample_count_ += samples;
}

double Film::add_pixel(size_t i, const PassPixel& pixel) {
  double total[lanes_] = {};
  Fixed* sum = sums(i);
  for (int c = 0; c < component_count; ++c)
    for (int lane = 0; lane < lanes_; ++lane) {
      const double value = pixel.radiance[size_t(c)][lane];
      sum[c * lanes_ + lane] += fixed_from(value);
      total[lane] += value;
    }
  for (int lane = 0; lane < lanes_; ++lane)
    squares_[i * lanes_ + size_t(lane)] += fixed_from(total[lane] * total[lane]);
  const FirstHit& hit = pixel.first_hit;
  const double first[first_hit_lanes] = {hit.albedo[0], hit.albedo[1], hit.albedo[2], hit.normal.x,
                                         hit.normal.y,  hit.normal.z,  hit.depth};
  for (size_t k = 0; k < first_hit_lanes; ++k)
    first_hits_[i * first_hit_lanes + k] += fixed_from(first[k]);
  for (size_t k = 0; k < noise_kinds; ++k)
    sample_squares_[i * noise_kinds + k] += fixed_from(double(pixel.squares[k]));
  return photopic(Vec3f(float(total[0]), float(total[1]), float(total[2])));
}

Spectrum Film::mean(size_t pixel) const {
  Spectrum result;
  const Fixed* sum = sums(pixel);
  for (int lane = 0; lane < lanes_; ++lane) {
    Fixed total = 0;
    for (int c = 0; c < component_count; ++c) total += sum[c * lanes_ + lane];
    result.set(lane, float(double_from(total) / pass_count_));
  }
  return result;
}

double Film::variance_of_mean(size_t pixel, int lane) const {
  if (pass_count_ < 2) return 0;
  const double n = pass_count_;
  Fixed total = 0;
  for (int c = 0; c < component_count; ++c) total += sums(pixel)[c * lanes_ + lane];
  const double m = double_from(total) / n;
  const double square = double_from(squares_[pixel * lanes_ + size_t(lane)]) / n;
  return std::max(0.0, square - m * m) / (n - 1);
}

std::array<double, noise_kinds> Film::noise(size_t pixel) const {
  std::array<double, noise_kinds> result{};
  const double passes = pass_count_, samples = double(sample_count_);
  std::array<Spectrum, component_count> means;
  for (int c = 0; c < component_count; ++c)
    for (int lane = 0; lane < lanes_; ++lane)
      means[size_t(c)].set(lane, float(double_from(sums(pixel)[c * lanes_ + lane]) / passes));
  const std::array<float, noise_kinds> mean = by_noise_kind(means);
  for (size_t k = 0; k < noise_kinds; ++k) {
    const double square = double_from(sample_squares_[pixel * noise_kinds + k]) / passes;
    result[k] = std::sqrt(std::max(0.0, square - double(sqr(mean[k]))) / (samples - 1));
  }
  return result;
}

Image Film::image() const {
  std::vector<std::string> names = {"R", "G", "B"};
  for (int c = 0; c < component_count; ++c)
    for (const char* lane : {"R", "G", "B"})
      if (components_.has(Component(c)))
        names.push_back(fmt::format("{}.{}", component_names[size_t(c)], lane));
  for (const char* name : {"albedo.R", "albedo.G", "albedo.B", "N.X", "N.Y", "N.Z", "depth.Z",
                           "error.R", "error.G", "error.B"})
    names.emplace_back(name);
  const bool knows_noise = sample_count_ >= 2;
  if (knows_noise) names.insert(names.end(), {"noise.scattered", "noise.mirrored"});
  Image image(size_.x, size_.y, names);
  if (pass_count_ == 0) return image;
  parallel_blocks(size_t(size_.y), 1, [&](size_t row, size_t, size_t) {
    const auto y = int(row);
    for (int x = 0; x < size_.x; ++x) {
      const size_t pixel = row * size_t(size_.x) + size_t(x);
      const Spectrum total = mean(pixel);
      int channel = 0;
      for (int lane = 0; lane < lanes_; ++lane) image.at(x, y, channel++) = total[lane];
      for (int c = 0; c < component_count; ++c)
        for (int lane = 0; lane < lanes_; ++lane)
          if (components_.has(Component(c)))
            image.at(x, y, channel++) =
                float(double_from(sums(pixel)[c * lanes_ + lane]) / pass_count_);
      for (size_t k = 0; k < first_hit_lanes; ++k)
        image.at(x, y, channel++) =
            float(double_from(first_hits_[pixel * first_hit_lanes + k]) / pass_count_);
      for (int lane = 0; lane < lanes_; ++lane)
        image.at(x, y, channel++) = float(std::sqrt(variance_of_mean(pixel, lane)));
      if (knows_noise)
        for (const double deviation : noise(pixel)) image.at(x, y, channel++) = float(deviation);
    }
  });
  return image;
}

double Film::mean_error() const {
  RunningStatistics means;
  for (size_t r = 0; r < replicate_count; ++r)
    if (replicate_passes_[r] > 0) means.add(double_from(replicate_sums_[r]) / replicate_passes_[r]);
  if (means.count() < 2 || !(means.mean() > 0)) return std::numeric_limits<double>::infinity();
  return student_t_quantile(0.975, double(means.count() - 1)) * means.standard_error() /
         means.mean();
}

double Film::relative_noise() const {
  if (pass_count_ < 2) return std::numeric_limits<double>::infinity();
  const size_t pixels = size_t(size_.x) * size_t(size_.y);
  const auto sum = sum_over_blocks<double>(pixels, [&](size_t begin, size_t end) {
    double block = 0;
    for (size_t i = begin; i < end; ++i) {
      const Spectrum m = mean(i);
      for (int lane = 0; lane < lanes_; ++lane)
        block += variance_of_mean(i, lane) / (sqr(m[lane]) + 0.01);
    }
    return block;
  });
  return std::sqrt(sum / (double(pixels) * lanes_));
}

}  // namespace kaustik
