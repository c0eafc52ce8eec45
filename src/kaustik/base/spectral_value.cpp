#include "kaustik/base/spectral_value.h"

#include <algorithm>
#include <functional>

#include "kaustik/base/color.h"

namespace kaustik {
namespace {

class Tabulated final : public SpectralFunction {
 public:
  Tabulated(SpectralCurve curve, bool is_zero_outside)
      : samples_(std::move(curve.samples)), is_zero_outside_(is_zero_outside) {}
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

 private:
  std::vector<std::pair<double, double>> samples_;
  bool is_zero_outside_;
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

/// By a formula.
class Computed final : public SpectralFunction {
 public:
  using Formula = std::function<double(double)>;
  explicit Computed(Formula formula) : formula_(std::move(formula)) {}
  double at(double nm) const override { return formula_(nm); }

 private:
  Formula formula_;
};

SpectralFunctionPointer computed(Computed::Formula formula) {
  return std::make_shared<Computed>(std::move(formula));
}

/// Of a function that takes lanes.
SpectralFunctionPointer by_lanes(const Spectrum& rgb,
                                 Spectrum (*lanes)(const Spectrum&, const Wavelengths&)) {
  return computed([rgb, lanes](double nm) {
    const auto x = float(nm);
    return double(lanes(rgb, Wavelengths(x, x, x, x))[0]);
  });
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
  return {rgb, computed([a, b](double nm) { return a.value_at(nm) * b.value_at(nm); })};
}

SpectralValue operator+(const SpectralValue& a, const SpectralValue& b) {
  const Spectrum rgb = a.rgb_ + b.rgb_;
  if (a.is_constant() && b.is_constant())
    return SpectralValue(a.constant_ + b.constant_).with_rgb(rgb);
  return {rgb, computed([a, b](double nm) { return a.value_at(nm) + b.value_at(nm); })};
}

SpectralValue SpectralValue::with_rgb(const Spectrum& rgb) const {
  SpectralValue result = *this;
  result.rgb_ = rgb;
  return result;
}

Spectrum SpectralValue::at_wavelengths(const Wavelengths& wavelengths) const {
  if (!function_) return Spectrum(constant_);
  Spectrum result;
  for (int i = 0; i < Spectrum::lane_count; ++i)
    result.set(i, float(function_->at(double(wavelengths[i]))));
  return result;
}

}  // namespace kaustik
