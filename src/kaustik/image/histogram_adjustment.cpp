#include "kaustik/image/histogram_adjustment.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kaustik/base/to_integer.h"
#include "kaustik/image/vision.h"

namespace kaustik {
namespace {

double sum_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Weights 1 4 6 4 1 with the ends mirrored: keeps the sum, and no bin next to a full one is empty.
std::vector<double> smoothed(const std::vector<double>& bins) {
  static constexpr double weights[] = {1 / 16., 4 / 16., 6 / 16., 4 / 16., 1 / 16.};
  const int count = int(bins.size());
  std::vector<double> result(bins.size(), 0.0);
  for (int i = 0; i < count; ++i)
    for (int offset = -2; offset <= 2; ++offset) {
      int j = i + offset;
      if (j < 0) j = -1 - j;
      if (j >= count) j = 2 * count - 1 - j;
      result[size_t(j)] += weights[offset + 2] * bins[size_t(i)];
    }
  return result;
}

/// Half of the interval where `sum_at`, which rises, crosses 1; `low` and `high` are logarithms.
template <typename Sum>
double crossing_of_one(double low, double high, const Sum& sum_at) {
  for (int i = 0; i < 100; ++i) {
    const double middle = (low + high) / 2;
    (sum_at(std::exp(middle)) < 1 ? low : high) = middle;
  }
  return std::exp(low);
}

/// Shares of the display's range, with sum 1: proportional to the bins, but at most the ceilings
/// (whose sum is at least 1) and at least a small part of them.
std::vector<double> shares_under(const std::vector<double>& bins,
                                 const std::vector<double>& ceilings) {
  constexpr double usual_floor = 0.15;
  const double all = sum_of(ceilings), total = sum_of(bins);
  const double floor = std::min(usual_floor, 0.25 / all);
  const auto shares = [&](double scale, double least) {
    std::vector<double> result(bins.size());
    for (size_t i = 0; i < bins.size(); ++i)
      result[i] = std::min(ceilings[i], std::max(scale * bins[i] / total, least * ceilings[i]));
    return result;
  };
  constexpr double most = 1e12;
  if (sum_of(shares(most, floor)) > 1)
    return shares(crossing_of_one(std::log(1e-12), std::log(most),
                                  [&](double scale) { return sum_of(shares(scale, floor)); }),
                  floor);
  // The crowded bins have all that they may have: the rest of the display is for the others.
  return shares(most, crossing_of_one(std::log(floor), 0.0,
                                      [&](double least) { return sum_of(shares(most, least)); }));
}

}  // namespace

HistogramAdjustment::HistogramAdjustment(const std::vector<float>& luminances,
                                         const HistogramSettings& settings)
    : settings_(settings),
      log_black_(std::log(settings.display_black)),
      log_white_(std::log(settings.display_white)) {
  std::vector<double> logs;
  for (const float value : luminances)
    if (value > 0 && std::isfinite(value)) logs.push_back(std::log(double(value)));
  if (!logs.empty()) {
    log_max_ = *std::max_element(logs.begin(), logs.end());
    // Eight decades show all that can be told apart; near-zeros must not stretch the scale.
    log_min_ = std::max(*std::min_element(logs.begin(), logs.end()), log_max_ - 8 * std::log(10.0));
  }
  // Float luminances that differ by a rounding are equal.
  constexpr double least_range = 1e-5;
  if (log_max_ - log_min_ > least_range) {
    const std::vector<double> bins = count(logs);
    is_linear_ = settings_.smooth ? !adjust_smoothly(bins) : !cut_as_in_the_paper(bins);
  }
  if (is_linear_) scale_linearly();
}

std::vector<double> HistogramAdjustment::count(const std::vector<double>& logs) const {
  const int last = settings_.bins - 1;
  std::vector<double> bins(size_t(settings_.bins), 0.0);
  for (const double value : logs) {
    const double x = (value - log_min_) / bin_width();
    if (!settings_.smooth) {
      ++bins[size_t(to_integer(x, 0, last))];
      continue;
    }
    // Shared between the two nearest bins, so that a small change of a sample is one of the curve.
    const double between = std::clamp(x - 0.5, 0.0, double(last));
    const int lower = to_integer(between, 0, last - 1);
    bins[size_t(lower)] += lower + 1 - between;
    bins[size_t(lower) + 1] += between - lower;
  }
  return settings_.smooth ? smoothed(bins) : bins;
}

/// dLd/dLw that the eye allows over Ld/Lw, by the present curve.
double HistogramAdjustment::visible_slope(double log_world) const {
  const double world = std::exp(log_world), display = std::exp(log_display(log_world));
  return visible_difference(display) / visible_difference(world) * world / display;
}

/// The largest share of the display's log range that each bin may have, by the present curve.
std::vector<double> HistogramAdjustment::ceilings() const {
  std::vector<double> result(size_t(settings_.bins), bin_width() / display_range());
  if (!settings_.human_contrast) return result;
  for (size_t i = 0; i < result.size(); ++i) {
    const double middle = log_min_ + (double(i) + 0.5) * bin_width(), half = bin_width() / 2;
    double slope = visible_slope(middle);
    // So that the limit holds in all of the bin.
    if (settings_.smooth)
      slope = std::min({slope, visible_slope(middle - half), visible_slope(middle + half)});
    result[i] *= slope;
  }
  return result;
}

void HistogramAdjustment::set_curve(const std::vector<double>& bins, double total) {
  cumulative_.assign(bins.size() + 1, 0.0);
  double below = 0;
  for (size_t i = 0; i < bins.size(); ++i) {
    below += bins[i];
    cumulative_[i + 1] = below / total;
  }
}

/// The iteration of section 4.3; false if the display's range is ample.
bool HistogramAdjustment::cut_as_in_the_paper(std::vector<double> bins) {
  const double tolerance = 0.025 * sum_of(bins);
  for (;;) {
    const double total = sum_of(bins);
    if (total < tolerance) return false;
    set_curve(bins, total);
    const std::vector<double> highest = ceilings();
    double cut = 0;
    for (size_t i = 0; i < bins.size(); ++i) {
      const double ceiling = total * highest[i];
      cut += std::max(0.0, bins[i] - ceiling);
      bins[i] = std::min(bins[i], ceiling);
    }
    if (cut > tolerance) continue;
    if (!(sum_of(bins) > 0)) return false;
    set_curve(bins, sum_of(bins));
    return true;
  }
}

/// False if luminance is to be scaled. With human contrast the ceilings depend on the curve, which
/// is therefore found by going half the way to the next one again and again.
bool HistogramAdjustment::adjust_smoothly(const std::vector<double>& bins) {
  if (!settings_.human_contrast) {
    const std::vector<double> highest = ceilings();
    if (sum_of(highest) < 1) return false;
    set_curve(shares_under(bins, highest), 1);
    return true;
  }
  std::vector<double> shares(bins.size(), 1 / double(bins.size()));
  constexpr int rounds = 60;
  for (int round = 0; round < rounds; ++round) {
    set_curve(shares, 1);
    const std::vector<double> highest = ceilings();
    const std::vector<double> next = sum_of(highest) < 1 ? highest : shares_under(bins, highest);
    for (size_t i = 0; i < shares.size(); ++i) shares[i] = (shares[i] + next[i]) / 2;
  }
  set_curve(shares, 1);
  return true;
}

void HistogramAdjustment::scale_linearly() {
  const double world = (log_min_ + log_max_) / 2, display = (log_black_ + log_white_) / 2;
  log_scale_ =
      settings_.human_contrast
          ? std::log(visible_difference(std::exp(display)) / visible_difference(std::exp(world)))
          : display - world;
}

double HistogramAdjustment::log_display(double log_world) const {
  const double x =
      std::clamp((log_world - log_min_) / (log_max_ - log_min_), 0.0, 1.0) * settings_.bins;
  const size_t bin = to_integer(x, size_t(0), cumulative_.size() - 2);
  const double share =
      cumulative_[bin] + (x - double(bin)) * (cumulative_[bin + 1] - cumulative_[bin]);
  return log_black_ + display_range() * share;
}

float HistogramAdjustment::display_luminance(float world_luminance) const {
  if (!(world_luminance > 0)) return float(settings_.display_black);
  const double log_world = std::log(double(world_luminance));
  const double log_shown = is_linear_ ? log_world + log_scale_ : log_display(log_world);
  return float(std::clamp(std::exp(log_shown), settings_.display_black, settings_.display_white));
}

}  // namespace kaustik
