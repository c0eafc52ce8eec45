// Filters that other renderers have with negative lobes: "mitchell", "catmullrom", "lanczos".
//
// Camera rays are drawn from the filter, so that every sample belongs to one pixel alone. Of a
// filter with negative lobes some samples would count as negative light: even on an even wall the
// picture would be noisy. So only the lobe in the middle is kept.

#include <functional>

#include "kaustik/scene/filter_kinds.h"
#include "kaustik/scene/offset_table.h"

namespace kaustik {
namespace {

/// An even function of the offset that falls from the centre to its first zero.
using Lobe = std::function<double(double)>;

/// The first zero of a lobe that has one within `radius`, else that.
double first_zero(const Lobe& lobe, double radius) {
  constexpr int steps = 4096;
  for (int i = 1; i <= steps; ++i)
    if (!(lobe(radius * i / steps) > 0)) {
      double inside = radius * (i - 1) / steps, outside = radius * i / steps;
      for (int halving = 0; halving < 40; ++halving) {
        const double middle = (inside + outside) / 2;
        (lobe(middle) > 0 ? inside : outside) = middle;
      }
      return inside;
    }
  return radius;
}

class MiddleLobe final : public FilterProfile {
 public:
  /// `is_cut`: the lobe has neighbours.
  MiddleLobe(Lobe lobe, double radius, bool is_cut)
      : lobe_(std::move(lobe)),
        is_cut_(is_cut),
        sums_(sums_of(lobe_, radius)),
        offsets_(float(radius), [&](float x) { return share_below(double(x) / radius); }) {
    norm_ = 1 / (2 * sums_.back() * radius);
  }
  float density(float distance) const override {
    return float(std::max(0.0, lobe_(double(distance))) * norm_);
  }
  float sample(float u) const override { return offsets_.sample(u); }
  bool is_cut() const override { return is_cut_; }

 private:
  static constexpr size_t steps = 4096;

  /// Integrals from the centre on, in units of the radius, by the trapezoidal rule.
  static std::vector<double> sums_of(const Lobe& lobe, double radius) {
    std::vector<double> sums = {0};
    for (size_t i = 0; i < steps; ++i) {
      const auto at = [&](size_t k) { return lobe(radius * double(k) / double(steps)); };
      sums.push_back(sums.back() + (at(i) + at(i + 1)) / 2 / double(steps));
    }
    return sums;
  }
  /// `x`: the offset in units of the radius.
  float share_below(double x) const {
    const double place = std::min(std::fabs(x), 1.0) * double(steps);
    const size_t step = std::min(size_t(place), steps - 1);
    const double sum = std::lerp(sums_[step], sums_[step + 1], place - double(step));
    return float(0.5 + std::copysign(sum / sums_.back() / 2, x));
  }

  Lobe lobe_;
  bool is_cut_;
  std::vector<double> sums_;
  OffsetTable offsets_;
  double norm_ = 1;
};

PixelFilter middle_lobe(const Lobe& lobe, double radius) {
  const double zero = first_zero(lobe, radius);
  const bool is_cut = zero < 0.999 * radius;  // it may end in a zero
  return {float(zero), std::make_shared<const MiddleLobe>(lobe, zero, is_cut)};
}

/// Mitchell and Netravali, "Reconstruction Filters in Computer Graphics", SIGGRAPH 1988,
/// equation 8.
Lobe cubic(double b, double c) {
  return [b, c](double x) {
    const double sq = x * x, cube = sq * x;
    if (x < 1) return ((12 - 9 * b - 6 * c) * cube + (-18 + 12 * b + 6 * c) * sq + 6 - 2 * b) / 6;
    if (x >= 2) return 0.0;
    return ((-b - 6 * c) * cube + (6 * b + 30 * c) * sq + (-12 * b - 48 * c) * x + 8 * b + 24 * c) /
           6;
  };
}

Lobe windowed_sinc(double lobes) {
  return [lobes](double x) {
    const auto sinc = [](double t) {
      return t < 1e-6 ? 1 : std::sin(double(pi) * t) / (double(pi) * t);
    };
    return x >= lobes ? 0.0 : sinc(x) * sinc(x / lobes);
  };
}

constexpr const char* kept =
    " Only the central lobe is kept, because negative lobes would add noise.";

TypeInfo row(const std::string& name, const std::string& sentence, std::vector<Parameter> rows) {
  return {"rfilter", name, sentence + kept, std::move(rows)};
}

}  // namespace

FilterType mitchell_filter_type() {
  static const TypeInfo info =
      row("mitchell", "Mitchell and Netravali's cubic, a compromise between blur and ringing.",
          {number_parameter("B", 1.0 / 3, "Weight of the smooth B-spline.").range(0, 1),
           number_parameter("C", 1.0 / 3, "Strength of the negative lobes.").range(0, 1)});
  return {info, [](const Arguments& arguments) {
            return middle_lobe(cubic(arguments.number("B"), arguments.number("C")), 2);
          }};
}

FilterType catmull_rom_filter_type() {
  static const TypeInfo info = row("catmullrom", "Catmull and Rom's cubic.", {});
  return {info, [](const Arguments&) { return middle_lobe(cubic(0, 0.5), 2); }};
}

FilterType lanczos_filter_type() {
  static const TypeInfo info =
      row("lanczos", "Lanczos's windowed sinc.",
          {integer_parameter("lobes", 3, "Number of lobes on each side.").range(1, 10)});
  return {info, [](const Arguments& arguments) {
            const auto lobes = double(arguments.integer("lobes"));
            return middle_lobe(windowed_sinc(lobes), lobes);
          }};
}

}  // namespace kaustik
