#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "kaustik/material/fresnel.h"
#include "kaustik/material/glass_data.h"

namespace kaustik {
namespace {

constexpr double sodium_d_nm = 589.3;

struct NamedIor {
  const char* name;
  float value;
};
// Mitsuba's table (after Hecht, Optics, 4th edition), so that scenes mean the same here.
constexpr NamedIor named_iors[] = {
    {"vacuum", 1.0f},      {"helium", 1.000036f},        {"hydrogen", 1.000132f},
    {"air", 1.000277f},    {"carbon dioxide", 1.00045f}, {"water", 1.3330f},
    {"acetone", 1.36f},    {"ethanol", 1.361f},          {"carbon tetrachloride", 1.461f},
    {"glycerol", 1.4729f}, {"benzene", 1.501f},          {"silicone oil", 1.52045f},
    {"bromine", 1.661f},   {"water ice", 1.31f},         {"fused quartz", 1.458f},
    {"pyrex", 1.470f},     {"acrylic glass", 1.49f},     {"polypropylene", 1.49f},
    {"bk7", 1.5046f},      {"sodium chloride", 1.544f},  {"amber", 1.55f},
    {"pet", 1.5750f},      {"diamond", 2.419f}};

std::optional<float> listed_ior(std::string_view name) {
  for (const NamedIor& ior : named_iors)
    if (name == ior.name) return ior.value;
  return std::nullopt;
}

const MeasuredGlass* measured_glass(std::string_view name) {
  const auto all = measured_glasses();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const auto& glass) { return name == glass.name; });
  return found == all.end() ? nullptr : &*found;
}

class Sellmeier final : public SpectralFunction {
 public:
  explicit Sellmeier(const MeasuredGlass& glass) : glass_(glass) {}
  double at(double nm) const override {
    const double um_sq = sqr(nm / 1000);
    double n_sq = glass_.constant;
    for (const MeasuredGlass::Term& term : glass_.terms)
      n_sq += term.strength * um_sq / (um_sq - term.resonance_um2);
    return std::sqrt(n_sq);
  }

 private:
  static double sqr(double x) { return x * x; }
  const MeasuredGlass& glass_;
};

/// Of Cauchy's two terms.
class Cauchy final : public SpectralFunction {
 public:
  /// n = n_d at the helium d line, n_F − n_C = (n_d − 1)/abbe between hydrogen's F and C.
  Cauchy(double n_d, double abbe) : n_d_(n_d), slope_((n_d - 1) / abbe / (per_sq(f) - per_sq(c))) {}
  double at(double nm) const override {
    // Of an index below 1 with a small Abbe number nothing would be left.
    return std::max(least, n_d_ + slope_ * (per_sq(nm) - per_sq(d)));
  }

 private:
  static constexpr double least = 0.05;
  static constexpr double f = 486.134, d = 587.562, c = 656.281;
  static constexpr double per_sq(double nm) { return 1 / (nm * nm); }
  double n_d_, slope_;
};

}  // namespace

SpectralValue dispersive_ior(const SpectralFunctionPointer& function) {
  return {Spectrum(float(function->at(sodium_d_nm))), function};
}

SpectralValue ior_by_abbe_number(float n_d, float abbe) {
  return {Spectrum(n_d), std::make_shared<Cauchy>(double(n_d), double(abbe))};
}

float dielectric_ior(std::string_view name) { return named_ior(name).rgb()[0]; }

SpectralValue named_ior(std::string_view name) {
  const std::optional<float> listed = listed_ior(name);
  if (const MeasuredGlass* glass = measured_glass(name)) {
    const SpectralValue measured = dispersive_ior(std::make_shared<Sellmeier>(*glass));
    return listed ? measured.with_rgb(Spectrum(*listed)) : measured;
  }
  if (!listed) throw std::out_of_range("unknown dielectric");
  return SpectralValue(*listed);
}

std::vector<std::string> dielectric_names() {
  std::vector<std::string> names;
  for (const NamedIor& ior : named_iors) names.emplace_back(ior.name);
  for (const MeasuredGlass& glass : measured_glasses())
    if (!listed_ior(glass.name)) names.emplace_back(glass.name);
  return names;
}

}  // namespace kaustik
