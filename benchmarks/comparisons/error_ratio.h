#pragma once
#include <cmath>
#include <optional>
#include <string>

namespace kaustik::bench {

/// How one error stands to another, as far as it is known.
struct ErrorRatio {
  double value = 1;
  bool may_be_more = false, may_be_less = false;

  /// "1.52"; "> 1.52" or "< 0.9" where the value is a bound, "~ 1.02" where it is neither.
  std::string text() const;
};

/// As measured; nothing: one of the two was not.
std::optional<ErrorRatio> measured_ratio(std::optional<double> of, std::optional<double> to);

/// Of what is left of two errors that were measured against the same reference without its own
/// noise, which is part of both. Where that is not known or more than half of one of them, what is
/// left tells little: then it is the ratio as measured, as a bound, for without the noise it is
/// farther from 1.
std::optional<ErrorRatio> noiseless_ratio(std::optional<double> of, std::optional<double> to,
                                          std::optional<double> reference_noise);

/// Over the ratios that there are; a bound if some of them are.
class GeometricMean {
 public:
  void add(const std::optional<ErrorRatio>& ratio);
  int count() const { return count_; }
  std::optional<ErrorRatio> value() const;

 private:
  double sum_of_logarithms_ = 0;
  int count_ = 0;
  ErrorRatio bounds_;  ///< its value is of no meaning
};

enum class Verdict { kept, missed, unknown };
Verdict at_least(const ErrorRatio& ratio, double bar);
Verdict at_most(const ErrorRatio& ratio, double bar);
/// "kept", "missed", "can't be told".
std::string text_of(Verdict verdict);

}  // namespace kaustik::bench
