#pragma once
#include <memory>
#include <variant>

#include "kaustik/base/parameters.h"
#include "kaustik/base/wavelengths.h"

namespace kaustik {

/// A function of the wavelength. Immutable.
class SpectralFunction {
 public:
  virtual ~SpectralFunction() = default;
  /// `nm`: the wavelength in vacuum.
  virtual double at(double nm) const = 0;
  /// The same of all lanes, which some know sooner together. Not in RGB mode.
  virtual Spectrum at_lanes(const Wavelengths& wavelengths) const {
    Spectrum result;
    for (int lane = 0; lane < Spectrum::lane_count; ++lane)
      result.set(lane, float(at(double(wavelengths[lane]))));
    return result;
  }
};
using SpectralFunctionPointer = std::shared_ptr<const SpectralFunction>;

/// Linear between the samples, at least one; constant outside …
SpectralFunctionPointer tabulated(SpectralCurve curve);
/// … or zero, as Mitsuba has it for light and reflectances.
SpectralFunctionPointer tabulated_within(SpectralCurve curve);
/// Planck's radiance of a black body, W/(sr·m²·nm). `kelvin` above 0.
SpectralFunctionPointer blackbody(double kelvin);

/// A quantity that depends on the wavelength: a reflectance, a radiance, an extinction, an index of
/// refraction. Scenes describe it once; it stays a function until transport asks for its lanes. Its
/// lanes in RGB mode are computed once, when it is made. Immutable, cheap to copy.
class SpectralValue {
 public:
  /// Zero.
  SpectralValue() = default;
  /// The same at every wavelength, and in all four lanes of RGB mode.
  explicit SpectralValue(float constant) : rgb_(constant), constant_(constant) {}
  /// `rgb`: the lanes in RGB mode.
  SpectralValue(const Spectrum& rgb, SpectralFunctionPointer function)
      : rgb_(rgb), function_(std::move(function)) {}

  /// What a `color` argument means for something that reflects: a curve as it is, zero beyond its
  /// ends; a colour by lanes_from_reflectance.
  static SpectralValue reflectance(const std::variant<Rgb, SpectralCurve>& color);
  /// The same for something that emits: a curve as it is, a colour by lanes_from_emission.
  static SpectralValue emission(const std::variant<Rgb, SpectralCurve>& color);
  /// The same for an index of refraction, an extinction and the like: as of something that
  /// reflects, but a curve stays as it is beyond its ends.
  static SpectralValue material_constant(const std::variant<Rgb, SpectralCurve>& color);
  /// A function of emission; its RGB lanes are those of rgb_from_emission.
  static SpectralValue emission(const SpectralFunctionPointer& function);

  Spectrum at(const Wavelengths& wavelengths) const {
    return wavelengths.is_rgb() ? rgb_ : at_wavelengths(wavelengths);
  }
  /// In RGB mode.
  const Spectrum& rgb() const { return rgb_; }
  /// Whether it is known to be the same at every wavelength.
  bool is_constant() const { return !function_; }

  /// Lane by lane, wavelength by wavelength.
  friend SpectralValue operator*(const SpectralValue& a, float factor);
  friend SpectralValue operator*(const SpectralValue& a, const SpectralValue& b);
  friend SpectralValue operator+(const SpectralValue& a, const SpectralValue& b);

  /// The same with other lanes in RGB mode.
  SpectralValue with_rgb(const Spectrum& rgb) const;

 private:
  Spectrum at_wavelengths(const Wavelengths& wavelengths) const;

  Spectrum rgb_;
  float constant_ = 0;                ///< if there is no function
  SpectralFunctionPointer function_;  ///< null: constant
};

}  // namespace kaustik
