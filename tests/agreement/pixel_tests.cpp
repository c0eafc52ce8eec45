#include "tests/agreement/pixel_tests.h"

#include <algorithm>
#include <cmath>

#include "kaustik/base/error.h"
#include "kaustik/base/statistics.h"
#include "kaustik/image/image_io.h"
#include "tests/agreement/sign_flips.h"

namespace kaustik::agreement {
namespace {

constexpr double freedom = replicate_total - 1;
constexpr const char* error_suffix = ".error";

/// The largest 16-bit float, and the least that has all its digits.
constexpr float most_half = 65504, least_half = 6.104e-5f;
/// Standard deviation of what rounding to 11 binary digits does, as a share.
constexpr double rounding = 1.0 / 2048 / 1.7320508;

/// Whether a pixel has light enough to count.
std::vector<bool> lit_pixels(const std::vector<float>& light) {
  double sum = 0;
  for (const float value : light) sum += double(value);
  const double least = dark_share * sum / double(light.size());
  std::vector<bool> is_lit(light.size());
  for (size_t i = 0; i < light.size(); ++i) is_lit[i] = light[i] > 0 && double(light[i]) >= least;
  return is_lit;
}

}  // namespace

PixelReference moments_of(const Components& pixels) {
  PixelReference reference;
  for (const auto& [component, replicates] : pixels) {
    PixelMoments& moments = reference[component];
    for (size_t i = 0; i < replicates.at(0).size(); ++i) {
      RunningStatistics statistics;
      for (const std::vector<float>& row : replicates) statistics.add(double(row[i]));
      moments.mean.push_back(float(statistics.mean()));
      moments.standard_error.push_back(
          float(std::hypot(statistics.standard_error(), rounding * statistics.mean())));
    }
  }
  return reference;
}

void write_pixels(const PixelReference& reference, const std::string& path) {
  const size_t pixels = reference.begin()->second.mean.size();
  const int columns = int(std::lround(std::sqrt(double(pixels))));
  Image image(columns, columns, {});
  for (const auto& [component, moments] : reference) {
    const int means = image.add_channel(component);
    const int errors = image.add_channel(component + error_suffix);
    const std::vector<bool> is_lit = lit_pixels(moments.mean);
    for (size_t i = 0; i < pixels; ++i) {
      const float mean = moments.mean[i];
      if (mean > most_half || (is_lit[i] && mean < least_half))
        throw Error(ErrorKind::input, path + ": " + component + " is beyond 16 bits");
      image.channel(means)[i] = mean;
      image.channel(errors)[i] = mean > 0 ? moments.standard_error[i] / mean : 0.0f;
    }
  }
  write_image(image, path);
}

PixelReference read_pixels(const std::string& path) {
  const Image image = read_image(path);
  PixelReference reference;
  for (const std::string& name : image.channel_names()) {
    if (name.ends_with(error_suffix)) continue;
    const int errors = image.find_channel(name + error_suffix);
    if (errors < 0)
      throw Error(ErrorKind::input, path + " has no channel " + name + error_suffix,
                  "make it anew: make_block_references");
    PixelMoments& moments = reference[name];
    const auto means = image.channel(image.find_channel(name));
    const auto shares = image.channel(errors);
    moments.mean.assign(means.begin(), means.end());
    for (size_t i = 0; i < means.size(); ++i)
      moments.standard_error.push_back(shares[i] * means[i]);
  }
  return reference;
}

PixelVerdict compare_pixels(const Replicates& tested, const PixelMoments& reference, int columns) {
  const size_t pixels = reference.mean.size();
  const std::vector<bool> is_lit = lit_pixels(reference.mean);
  std::vector<double> means(pixels), tested_variance(pixels), reference_variance(pixels);
  for (size_t i = 0; i < pixels; ++i) {
    if (!is_lit[i]) continue;
    const double light = double(reference.mean[i]);
    RunningStatistics statistics;
    for (const std::vector<float>& row : tested) statistics.add(double(row[i]) / light);
    means[i] = statistics.mean();
    tested_variance[i] = statistics.variance() / replicate_total;
    const double share = double(reference.standard_error[i]) / light;
    reference_variance[i] = share * share;
  }
  const std::vector<double> tested_around = means_of_lit(tested_variance, is_lit, columns),
                            reference_around = means_of_lit(reference_variance, is_lit, columns);
  PixelVerdict verdict;
  std::vector<double> errors;
  for (size_t i = 0; i < pixels; ++i) {
    if (!is_lit[i]) continue;
    const double error = std::sqrt(std::max(tested_variance[i], tested_around[i]) +
                                   std::max(reference_variance[i], reference_around[i]));
    errors.push_back(error);
    const double t = (means[i] - 1) / error;
    if (std::fabs(t) > std::fabs(verdict.worst_t)) {
      verdict.worst_t = t;
      verdict.worst_pixel = int(i);
    }
  }
  verdict.counted = errors.size();
  if (errors.empty()) return verdict;
  const double p = 2 * student_t_cdf(-std::fabs(verdict.worst_t), freedom);
  verdict.p_worst = -std::expm1(double(verdict.counted) * std::log1p(-std::min(p, 1 - 1e-16)));
  std::nth_element(errors.begin(), errors.begin() + std::ptrdiff_t(errors.size() / 2),
                   errors.end());
  const double of_one = sidak_level(pixel_level, int(verdict.counted));
  verdict.median_found =
      errors[errors.size() / 2] * std::fabs(student_t_quantile(of_one / 2, freedom));
  return verdict;
}

}  // namespace kaustik::agreement
