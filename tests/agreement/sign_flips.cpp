#include "tests/agreement/sign_flips.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "kaustik/base/statistics.h"
#include "kaustik/transport/block_means.h"

namespace kaustik::agreement {
namespace {

constexpr size_t R = replicate_total;
constexpr int reach = 3;                    ///< cells to every side that tell of a cell's noise
using Differences = std::array<double, R>;  ///< of one block

Differences differences(const Replicates& tested, const Replicates& reference, size_t block,
                        double planted) {
  Differences d{};
  for (size_t r = 0; r < R; ++r)
    d[r] = (1 + planted) * double(tested[r][block]) - double(reference[r][block]);
  return d;
}

RunningStatistics statistics_of(const Differences& d) {
  RunningStatistics statistics;
  for (const double value : d) statistics.add(value);
  return statistics;
}

/// Two-sided.
double student_p(double t) { return 2 * student_t_cdf(-std::fabs(t), double(R - 1)); }

/// Of the smallest of so many independent ones.
double sidak_p(double least_p, size_t count) {
  return -std::expm1(double(count) * std::log1p(-std::min(least_p, 1 - 1e-16)));
}

/// Share of all choices of signs s for which s' K s is as large as for all signs alike.
double share_of_signs(const std::array<Differences, R>& k) {
  Differences ks{};  // K s
  double own = 0;
  for (size_t i = 0; i < R; ++i)
    for (size_t j = 0; j < R; ++j) ks[i] += k[i][j];
  for (const double value : ks) own += value;
  double now = own;
  std::array<double, R> sign;
  sign.fill(1);
  // The last sign stays, since all may be turned at once. By Gray's code one changes at a time.
  const uint32_t patterns = 1u << (R - 1);
  uint32_t as_large = 1;
  for (uint32_t i = 1; i < patterns; ++i) {
    const auto flipped = size_t(std::countr_zero(i));
    now += 4 * (k[flipped][flipped] - sign[flipped] * ks[flipped]);
    for (size_t j = 0; j < R; ++j) ks[j] -= 2 * sign[flipped] * k[j][flipped];
    sign[flipped] = -sign[flipped];
    if (now >= own * (1 - 1e-9)) ++as_large;
  }
  return double(as_large) / double(patterns);
}

/// Of one block: the renders' differences, how they scatter about their mean, and about zero. The
/// last is the same for all signs.
struct BlockDifferences {
  Differences d{};
  double mean = 0, variance = 0, mean_square = 0;
};

std::vector<BlockDifferences> all_differences(const Replicates& tested, const Replicates& reference,
                                              double planted) {
  std::vector<BlockDifferences> all(reference.at(0).size());
  for (size_t b = 0; b < all.size(); ++b) {
    all[b].d = differences(tested, reference, b, planted);
    const RunningStatistics statistics = statistics_of(all[b].d);
    all[b].mean = statistics.mean();
    all[b].variance = statistics.variance();
    for (const double value : all[b].d) all[b].mean_square += value * value / double(R);
  }
  return all;
}

/// Means of relative variances (or mean squares) over the blocks around each, in its own light.
/// `all` may hold more than the picture's blocks: to those it is the mean over the picture.
std::vector<double> noise_around(double BlockDifferences::*noise,
                                 const std::vector<BlockDifferences>& all,
                                 const std::vector<double>& light, size_t picture_blocks) {
  std::vector<double> relative(picture_blocks);
  std::vector<bool> is_lit(picture_blocks);
  RunningStatistics whole;
  for (size_t b = 0; b < picture_blocks; ++b) {
    is_lit[b] = light[b] > 0;
    if (!is_lit[b]) continue;
    relative[b] = all[b].*noise / (light[b] * light[b]);
    whole.add(relative[b]);
  }
  std::vector<double> around = means_of_lit(std::move(relative), is_lit,
                                            int(std::lround(std::sqrt(double(picture_blocks)))));
  around.resize(all.size(), whole.mean());
  for (size_t b = 0; b < all.size(); ++b) around[b] *= light[b] * light[b];
  return around;
}

double sum_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum;
}

/// Both sets with black in the place of dark blocks, and the sum of these as one more block.
std::pair<Replicates, Replicates> with_dark_ones_pooled(const Replicates& tested,
                                                        const Replicates& reference) {
  std::vector<double> brightness = mean_of_renders(tested);
  const std::vector<double> of_reference = mean_of_renders(reference);
  for (size_t b = 0; b < brightness.size(); ++b)
    brightness[b] = 0.5 * (brightness[b] + of_reference[b]);
  const double least = dark_share * sum_of(brightness) / double(brightness.size());
  const auto pooled = [&](const Replicates& replicates) {
    Replicates result;
    for (const std::vector<float>& row : replicates) {
      std::vector<float> kept = row;
      double dark = 0;
      for (size_t b = 0; b < row.size(); ++b)
        if (brightness[b] < least) {
          dark += double(row[b]);
          kept[b] = 0;
        }
      kept.push_back(float(dark));
      result.push_back(std::move(kept));
    }
    return result;
  };
  return {pooled(tested), pooled(reference)};
}

}  // namespace

std::vector<double> means_of_lit(std::vector<double> values, const std::vector<bool>& is_lit,
                                 int columns) {
  std::vector<double> lit(is_lit.begin(), is_lit.end());
  for (size_t i = 0; i < values.size(); ++i) values[i] *= lit[i];
  const Vec2i size(columns, columns);
  std::vector<double> means = means_around(values, size, reach);
  const std::vector<double> shares = means_around(lit, size, reach);
  for (size_t i = 0; i < means.size(); ++i) means[i] = shares[i] > 0 ? means[i] / shares[i] : 0;
  return means;
}

bool Verdict::rejects(double level) const {
  return std::min({p_mean, p_blocks, p_worst}) < sidak_level(level, 3);
}

Verdict compare(const Replicates& all_tested, const Replicates& all_reference, double planted) {
  const auto [tested, reference] = with_dark_ones_pooled(all_tested, all_reference);
  Verdict verdict;
  const std::vector<double> light = mean_of_renders(reference);
  const std::vector<BlockDifferences> all = all_differences(tested, reference, planted);
  const size_t picture_blocks = all_reference.at(0).size();
  const std::vector<double> variances =
      noise_around(&BlockDifferences::variance, all, light, picture_blocks);
  // The same for all signs, as variances about the mean would not be.
  const std::vector<double> mean_squares =
      noise_around(&BlockDifferences::mean_square, all, light, picture_blocks);
  std::array<Differences, R> k{};
  Differences whole{};
  size_t counted = 0;
  for (size_t b = 0; b < all.size(); ++b) {
    const Differences& d = all[b].d;
    for (size_t r = 0; r < R; ++r) whole[r] += d[r];
    if (!(all[b].mean_square > 0)) continue;  // both black
    ++counted;
    const double usual = double(R) * (mean_squares[b] > 0 ? mean_squares[b] : all[b].mean_square);
    for (size_t i = 0; i < R; ++i)
      for (size_t j = 0; j < R; ++j) k[i][j] += d[i] * d[j] / usual;
    const double t = all[b].mean / std::sqrt(std::max(all[b].variance, variances[b]) / double(R));
    if (std::fabs(t) > std::fabs(verdict.worst_t)) {
      verdict.worst_t = t;
      verdict.worst_block = int(b);
    }
  }
  if (counted == 0) return verdict;
  verdict.p_worst = sidak_p(student_p(verdict.worst_t), counted);
  verdict.p_blocks = share_of_signs(k);
  const RunningStatistics mean = statistics_of(whole);
  const double reference_sum = sum_of(light);
  verdict.p_mean = student_p(mean.mean() / mean.standard_error());
  verdict.mean_difference = mean.mean() / reference_sum;
  verdict.mean_difference_error = mean.standard_error() / reference_sum;
  return verdict;
}

double smallest_bias_found(const Replicates& tested, const Replicates& reference, double level) {
  for (double bias = 1e-4; bias < 1; bias *= 1.2)
    if (compare(tested, reference, bias).rejects(level) &&
        compare(tested, reference, -bias).rejects(level))
      return bias;
  return 1;
}

double p_beyond(const Replicates& tested, const Replicates& reference, double tolerance,
                double planted) {
  const std::vector<double> wanted = mean_of_renders(reference);
  double least_p = 1;
  for (size_t b = 0; b < wanted.size(); ++b) {
    const RunningStatistics d = statistics_of(differences(tested, reference, b, planted));
    const double excess = std::fabs(d.mean()) - tolerance * wanted[b];
    if (excess > 0)
      least_p = std::min(least_p, student_t_cdf(-excess / d.standard_error(), double(R - 1)));
  }
  return sidak_p(least_p, wanted.size());
}

double p_beyond_told(const Replicates& tested, const Replicates& reference, const Replicates& told,
                     double planted) {
  const size_t blocks = reference.at(0).size();
  double least_p = 1;
  for (size_t b = 0; b < blocks; ++b) {
    const Differences d = differences(tested, reference, b, planted);
    Differences left = d;
    for (size_t r = 0; r < R; ++r) left[r] -= double(told[r][b]);
    const RunningStatistics of_all = statistics_of(d), of_rest = statistics_of(left);
    // Between the two ends: no evidence. Beyond one of them: the nearer one is to be left.
    if (of_all.mean() * of_rest.mean() <= 0) continue;
    const double t = std::min(std::fabs(of_all.mean()) / of_all.standard_error(),
                              std::fabs(of_rest.mean()) / of_rest.standard_error());
    least_p = std::min(least_p, student_t_cdf(-t, double(R - 1)));
  }
  return sidak_p(least_p, blocks);
}

}  // namespace kaustik::agreement
