#include "kaustik/base/spectral_value.h"

#include <algorithm>
#include <functional>

#include "kaustik/base/color.h"

namespace kaustik {
namespace {

class Tabulated final : public SpectralFunction {
 public:
  Tabulated(SpectralCurve curve, bool is_zero_outside)
      : samples_(std::move(curve.samples)), is_zero_outside_(is_zero_outside) {
    const auto is_whole = [](const auto& sample) {
      return sample.first == std::floor(sample.first);
    };
    if (!std::all_of(samples_.begin(), samples_.end(), is_whole)) return;
    for (int nm = first_nm; nm <= last_nm; ++nm) by_nm_.push_back(float(at(nm)));
  }
  double at(double nm) const override {
    if (is_zero_outside_ && !(nm >= samples_.front().first && nm <= samples_.back().first))
      return 0;
    const auto next =
        std::upper_bound(samples_.begin(), samples_.end(), nm,
                         [](double x, const auto& sample) { return x < sample.first; });
    if (next == samples_.begin()) return samples_.front().second;
    if (next == samples_.end()) return samples_.back().second;
    const auto& [low_nm, low] = *(next - 1);
    return std::lerp(low, next->second, (nm - low_nm) / (next->first - low_nm));
  }
  Spectrum at_lanes(const Wavelengths& wavelengths) const override {
    if (by_nm_.empty()) return SpectralFunction::at_lanes(wavelengths);
    Spectrum result;
    for (int lane = 0; lane < Spectrum::lane_count; ++lane) {
      const float x =
          std::clamp(wavelengths[lane] - float(first_nm), 0.0f, float(last_nm - first_nm));
      const size_t row = std::min(size_t(x), by_nm_.size() - 2);
      result.set(lane, std::lerp(by_nm_[row], by_nm_[row + 1], x - float(row)));
    }
    return result;
  }

 private:
  static constexpr int first_nm = int(Wavelengths::first_nm), last_nm = int(Wavelengths::last_nm);
  std::vector<std::pair<double, double>> samples_;
  bool is_zero_outside_;
  /// Of each nm from the first to the last, where all samples lie at whole ones; else empty. What
  /// is zero outside falls to zero within 1 nm.
  std::vector<float> by_nm_;
};

class Blackbody final : public SpectralFunction {
 public:
  explicit Blackbody(double kelvin) : kelvin_(kelvin) {}
  double at(double nm) const override {
    constexpr double planck = 6.62607015e-34, light = 299792458, boltzmann = 1.380649e-23;
    const double m = nm * 1e-9;
    return 2e-9 * planck * light * light / std::pow(m, 5) /
           std::expm1(planck * light / (m * boltzmann * kelvin_));
  }

 private:
  double kelvin_;
};

/// Of two values, lane by lane.
template <typename Combine>
class Combined final : public SpectralFunction {
 public:
  Combined(SpectralValue a, SpectralValue b) : a_(std::move(a)), b_(std::move(b)) {}
  double at(double nm) const override {
    const auto x = float(nm);
    return double(at_lanes({x, x, x, x})[0]);
  }
  Spectrum at_lanes(const Wavelengths& wavelengths) const override {
    return Combine()(a_.at(wavelengths), b_.at(wavelengths));
  }

 private:
  SpectralValue a_, b_;
};

/// Of a colour, by a function that takes lanes.
class OfColor final : public SpectralFunction {
 public:
  using Lanes = Spectrum (*)(const Spectrum& rgb, const Wavelengths& wavelengths);
  OfColor(const Spectrum& rgb, Lanes lanes) : rgb_(rgb), lanes_(lanes) {}
  double at(double nm) const override {
    const auto x = float(nm);
    return double(at_lanes({x, x, x, x})[0]);
  }
  Spectrum at_lanes(const Wavelengths& wavelengths) const override {
    return lanes_(rgb_, wavelengths);
  }

 private:
  Spectrum rgb_;
  Lanes lanes_;
};

SpectralFunctionPointer by_lanes(const Spectrum& rgb, OfColor::Lanes lanes) {
  return std::make_shared<OfColor>(rgb, lanes);
}

bool is_grey(const Rgb& c) { return c.r == c.g && c.g == c.b; }

}  // namespace

SpectralFunctionPointer tabulated(SpectralCurve curve) {
  return std::make_shared<Tabulated>(std::move(curve), false);
}

SpectralFunctionPointer tabulated_within(SpectralCurve curve) {
  return std::make_shared<Tabulated>(std::move(curve), true);
}

SpectralFunctionPointer blackbody(double kelvin) { return std::make_shared<Blackbody>(kelvin); }

SpectralValue SpectralValue::reflectance(const std::variant<Rgb, SpectralCurve>& color) {
  const Spectrum rgb = reflectance_spectrum(color);
  if (const auto* curve = std::get_if<SpectralCurve>(&color))
    return {rgb, tabulated_within(*curve)};
  if (is_grey(std::get<Rgb>(color))) return SpectralValue(rgb[0]).with_rgb(rgb);
  return {rgb, by_lanes(rgb, lanes_from_reflectance)};
}

SpectralValue SpectralValue::emission(const std::variant<Rgb, SpectralCurve>& color) {
  const Spectrum rgb = emission_spectrum(color);
  if (const auto* curve = std::get_if<SpectralCurve>(&color))
    return {rgb, tabulated_within(*curve)};
  return rgb.is_zero() ? SpectralValue() : SpectralValue(rgb, by_lanes(rgb, lanes_from_emission));
}

SpectralValue SpectralValue::material_constant(const std::variant<Rgb, SpectralCurve>& color) {
  const auto* curve = std::get_if<SpectralCurve>(&color);
  if (!curve) return reflectance(color);
  // As far as anybody asks the ends are repeated.
  SpectralCurve held = *curve;
  const auto [first_nm, first] = held.samples.front();
  const auto [last_nm, last] = held.samples.back();
  if (first_nm > double(Wavelengths::first_nm))
    held.samples.insert(held.samples.begin(), {double(Wavelengths::first_nm), first});
  if (last_nm < double(Wavelengths::last_nm))
    held.samples.emplace_back(double(Wavelengths::last_nm), last);
  return {reflectance(held).rgb(), tabulated(*curve)};
}

SpectralValue SpectralValue::emission(const SpectralFunctionPointer& function) {
  SpectralCurve curve;
  for (int nm = int(Wavelengths::first_nm); nm <= int(Wavelengths::last_nm); ++nm)
    curve.samples.emplace_back(nm, function->at(nm));
  return {emission_spectrum(curve), function};
}

SpectralValue operator*(const SpectralValue& a, float factor) { return a * SpectralValue(factor); }

SpectralValue operator*(const SpectralValue& a, const SpectralValue& b) {
  const Spectrum rgb = a.rgb_ * b.rgb_;
  if (a.is_constant() && b.is_constant())
    return SpectralValue(a.constant_ * b.constant_).with_rgb(rgb);
  return {rgb, std::make_shared<Combined<std::multiplies<>>>(a, b)};
}

SpectralValue operator+(const SpectralValue& a, const SpectralValue& b) {
  const Spectrum rgb = a.rgb_ + b.rgb_;
  if (a.is_constant() && b.is_constant())
    return SpectralValue(a.constant_ + b.constant_).with_rgb(rgb);
  return {rgb, std::make_shared<Combined<std::plus<>>>(a, b)};
}

SpectralValue SpectralValue::with_rgb(const Spectrum& rgb) const {
  SpectralValue result = *this;
  result.rgb_ = rgb;
  return result;
}

Spectrum SpectralValue::at_wavelengths(const Wavelengths& wavelengths) const {
  return function_ ? function_->at_lanes(wavelengths) : Spectrum(constant_);
}

}  // namespace kaustik
