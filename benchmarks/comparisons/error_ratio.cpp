#include "benchmarks/comparisons/error_ratio.h"

#include <fmt/format.h>

namespace kaustik::bench {
namespace {

/// More of an error than this must not be the reference's.
constexpr double largest_noise_share = 0.5;

}  // namespace

std::string ErrorRatio::text() const {
  const char* sign = may_be_more ? (may_be_less ? "~ " : "> ") : may_be_less ? "< " : "";
  return fmt::format("{}{:.3g}", sign, value);
}

std::optional<ErrorRatio> measured_ratio(std::optional<double> of, std::optional<double> to) {
  if (!of || !to || !(*of > 0) || !(*to > 0)) return std::nullopt;
  return ErrorRatio{*of / *to};
}

std::optional<ErrorRatio> noiseless_ratio(std::optional<double> of, std::optional<double> to,
                                          std::optional<double> reference_noise) {
  std::optional<ErrorRatio> ratio = measured_ratio(of, to);
  if (!ratio) return std::nullopt;
  const bool tells =
      reference_noise && *reference_noise <= largest_noise_share * std::fmin(*of, *to);
  if (tells) return ErrorRatio{(*of - *reference_noise) / (*to - *reference_noise)};
  ratio->may_be_more = ratio->value > 1;
  ratio->may_be_less = ratio->value < 1;
  return ratio;
}

void GeometricMean::add(const std::optional<ErrorRatio>& ratio) {
  if (!ratio) return;
  sum_of_logarithms_ += std::log(ratio->value);
  ++count_;
  bounds_.may_be_more = bounds_.may_be_more || ratio->may_be_more;
  bounds_.may_be_less = bounds_.may_be_less || ratio->may_be_less;
}

std::optional<ErrorRatio> GeometricMean::value() const {
  if (count_ == 0) return std::nullopt;
  ErrorRatio mean = bounds_;
  mean.value = std::exp(sum_of_logarithms_ / count_);
  return mean;
}

Verdict at_least(const ErrorRatio& ratio, double bar) {
  if (ratio.value >= bar) return ratio.may_be_less ? Verdict::unknown : Verdict::kept;
  return ratio.may_be_more ? Verdict::unknown : Verdict::missed;
}

Verdict at_most(const ErrorRatio& ratio, double bar) {
  if (ratio.value <= bar) return ratio.may_be_more ? Verdict::unknown : Verdict::kept;
  return ratio.may_be_less ? Verdict::unknown : Verdict::missed;
}

std::string text_of(Verdict verdict) {
  if (verdict == Verdict::unknown) return "can't be told";
  return verdict == Verdict::kept ? "kept" : "missed";
}

}  // namespace kaustik::bench
