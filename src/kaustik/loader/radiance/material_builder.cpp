#include "kaustik/loader/radiance/material_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kaustik/loader/radiance/number_text.h"
#include "kaustik/loader/radiance/placement.h"

namespace kaustik::radiance {
namespace {

/// Below this no reflection grows toward grazing angles in Radiance (FRESTHRESH).
constexpr double least_fresnel = 0.018;

ObjectPointer ward_bsdf(const Paint& diffuse, const Paint& specular, double alpha_u, double alpha_v,
                        const Place& place) {
  const ObjectPointer ward = make_object("bsdf", "ward", place);
  give(*ward, "variant", std::string("balanced"));
  diffuse.put(*ward, "diffuse_reflectance");
  specular.put(*ward, "specular_reflectance");
  give(*ward, "alpha_u", std::min(alpha_u, 10.0));
  give(*ward, "alpha_v", std::min(alpha_v, 10.0));
  return ward;
}

}  // namespace

MaterialBuilder::MaterialBuilder(const Modifier& material, const Tint& tint, ObjectPointer texture,
                                 const std::optional<BsdfShares>& measured, Deviations& deviations)
    : material_(material),
      tint_(tint),
      texture_(std::move(texture)),
      measured_(measured),
      deviations_(deviations),
      place_(material.place()) {}

double MaterialBuilder::real(size_t index, double otherwise) const {
  return index < material_.reals().size() ? material_.reals()[index] : otherwise;
}

Rgb MaterialBuilder::colour(size_t first, double otherwise) const {
  return {real(first, otherwise), real(first + 1, otherwise), real(first + 2, otherwise)};
}

Paint MaterialBuilder::paint(const Rgb& colour) const {
  const Rgb all = product(colour, tint_.factor);
  if (largest_of(all) > 1 + 1e-9)
    approximated("its colour is above 1, and is taken as 1: nothing throws back more than it gets");
  return {clamped(all), texture_};
}

void MaterialBuilder::approximated(const std::string& what) const {
  deviations_.approximated(name_of(*material_.primitive), what, place_);
}
void MaterialBuilder::ignored(const std::string& what) const {
  deviations_.ignored(name_of(*material_.primitive), what, place_);
}

void MaterialBuilder::build(Appearance& made) {
  const std::string& type = material_.type();
  const double rough = std::fabs(real(4, 0));
  const double spec = std::clamp(real(3, 0), 0.0, 1.0);
  if (type == "plastic" || type == "metal")
    return build_plastic(made, type == "metal", spec, rough, rough);
  if (type == "trans")
    return build_trans(made, spec, rough, rough, std::clamp(real(5, 0), 0.0, 1.0),
                       std::clamp(real(6, 0), 0.0, 1.0));
  if (type == "plastic2" || type == "metal2" || type == "trans2") return build_anisotropic(made);
  if (type == "glass") return build_glass(made);
  if (type == "dielectric") return build_dielectric(made);
  if (type == "interface") return build_interface(made);
  if (type == "light" || type == "glow") return build_light(made, true);
  if (type == "illum") return build_light(made, false);
  if (type == "spotlight") return build_spotlight(made);
  if (type == "mirror") return build_mirror(made);
  if (type == "mist") return build_mist(made);
  if (type == "plasfunc" || type == "plasdata" || type == "metfunc" || type == "metdata") {
    approximated("the function of its highlight is left out: it is matt");
    made.bsdf = two_sided(matt(paint(colour(0, 0.5)), place_));
  } else if (type == "transfunc" || type == "transdata") {
    approximated("the function of its highlight is left out");
    build_trans(made, 0, 0.2, 0.2, std::clamp(real(4, 0), 0.0, 1.0),
                std::clamp(real(5, 0), 0.0, 1.0));
  } else if (type == "ashik2") {
    approximated("it is rendered by the model of Ward");
    made.bsdf = two_sided(ward_bsdf(paint(colour(0, 0.5)), Paint(clamped(colour(3))),
                                    std::sqrt(2 / (2 + std::max(real(6, 10), 0.0))),
                                    std::sqrt(2 / (2 + std::max(real(7, 10), 0.0))), place_));
  } else if (type == "BRTDfunc" || type == "WGMDfunc") {
    build_by_parts(made, 0, 6, "its functions are left out: its matt parts stay");
  } else if (type == "BSDF" || type == "aBSDF") {
    build_measured(made);
  } else if (type == "prism1" || type == "prism2") {
    approximated("it bends no light: light passes straight on");
    made.bsdf = clear_pane(Paint(Rgb{1, 1, 1}), place_);
  } else if (type == "antimatter") {
    ignored("surfaces that cut others are left out: what they cut stays whole");
  } else {
    approximated("it is rendered as a grey matt surface");
    made.bsdf = two_sided(matt(Paint(Rgb{0.5, 0.5, 0.5}), place_));
  }
}

/// Reflection by Fresnel's formulas for the index that reflects `spec` at normal incidence, as
/// Radiance estimates it; what enters is scattered so that the base throws back its colour's share
/// of it, whatever happens inside: ρ (1 − F) / (1 − ρ F) = colour.
ObjectPointer MaterialBuilder::smooth_plastic(const Rgb& colour, double spec) const {
  const double index = index_by_reflectance(spec), inner = inner_reflectance(index);
  const Rgb c = paint(colour).colour();
  const auto base = [&](double share) { return share / (1 - inner + inner * share); };
  const ObjectPointer plastic = make_object("bsdf", "plastic", place_);
  give(*plastic, "diffuse_reflectance", Rgb{base(c.r), base(c.g), base(c.b)});
  give(*plastic, "nonlinear", true);
  give(*plastic, "int_ior", index);
  give(*plastic, "ext_ior", 1.0);
  return plastic;
}

void MaterialBuilder::build_plastic(Appearance& made, bool is_metal, double spec, double alpha_u,
                                    double alpha_v) {
  const Rgb base = colour(0);
  const Paint white(Rgb{1, 1, 1});
  ObjectPointer bsdf;
  if (spec <= 0) {
    bsdf = matt(paint(base), place_);
  } else if (std::max(alpha_u, alpha_v) > 0) {
    // Exactly Ward's model; a roughness of zero along one axis alone is a small one.
    bsdf = ward_bsdf(paint(base).times(1 - spec),
                     is_metal ? paint(base).times(spec) : Paint(Rgb{spec, spec, spec}),
                     std::max(alpha_u, 1e-3), std::max(alpha_v, 1e-3), place_);
  } else if (!is_metal && spec >= least_fresnel && spec < 0.5 && !texture_) {
    bsdf = smooth_plastic(base, spec);
  } else {
    ObjectPointer mirror;
    if (is_metal) {
      mirror = make_object("bsdf", "conductor", place_);
      paint(base).put(*mirror, "reflectance");
    } else {
      mirror = perfect_mirror(white, place_);
    }
    if (spec >= 1) {
      bsdf = mirror;
    } else {
      bsdf = make_object("bsdf", "blendbsdf", place_);
      give(*bsdf, "weight", spec);
      nest(*bsdf, matt(paint(base), place_));
      nest(*bsdf, mirror);
    }
  }
  made.bsdf = two_sided(bsdf);
}

/// Its parts side by side: light thrown back and let through evenly, the highlight, and what goes
/// straight on, spread by the roughness.
void MaterialBuilder::build_trans(Appearance& made, double spec, double alpha_u, double alpha_v,
                                  double trans, double tspec) {
  const Paint base = paint(colour(0));
  const double rest = 1 - spec, largest = std::max(largest_of(base.colour()), 1e-9);
  const double reflected = rest * (1 - trans), scattered = rest * trans * (1 - tspec);
  const double straight = rest * trans * tspec;
  const bool is_rough = std::max(alpha_u, alpha_v) > 0;
  LobeSum sum(place_);
  if (const double share = (reflected + scattered) * largest; share > 0) {
    const ObjectPointer sheet = make_object("bsdf", "thinphong", place_);
    base.times(reflected / share).put(*sheet, "diffuse_reflectance");
    base.times(scattered / share).put(*sheet, "diffuse_transmittance");
    sum.add(sheet, share);
  }
  if (spec > 0) {
    const Paint white(Rgb{1, 1, 1}), black(Rgb{0, 0, 0});
    sum.add(two_sided(is_rough ? ward_bsdf(black, white, std::max(alpha_u, 1e-3),
                                           std::max(alpha_v, 1e-3), place_)
                               : perfect_mirror(white, place_)),
            spec);
  }
  if (const double share = straight * largest; share > 0) {
    const Paint through = base.times(1 / largest);
    if (is_rough) {
      // A Gaussian about the direction straight on, exp(−γ²/α²), is nearly cosⁿγ with n = 2/α².
      const ObjectPointer lobe = make_object("bsdf", "thinphong", place_);
      give(*lobe, "diffuse_reflectance", Rgb{0, 0, 0});
      give(*lobe, "diffuse_transmittance", Rgb{0, 0, 0});
      through.put(*lobe, "specular_transmittance");
      const double alpha = std::sqrt(std::max(alpha_u, 1e-3) * std::max(alpha_v, 1e-3));
      give(*lobe, "exponent", std::min(2 / (alpha * alpha), 1e5));
      sum.add(lobe, share);
    } else {
      sum.add(clear_pane(through, place_), share);
    }
  }
  made.bsdf = sum.bsdf();
}

void MaterialBuilder::build_anisotropic(Appearance& made) {
  const double spec = std::clamp(real(3, 0), 0.0, 1.0);
  double u = std::fabs(real(4, 0)), v = std::fabs(real(5, 0));
  // Where u points: three expressions; here three numbers.
  const auto& strings = material_.strings();
  std::optional<Vec3d> along;
  if (strings.size() >= 3) {
    Vec3d axis;
    bool are_numbers = true;
    for (int i = 0; i < 3; ++i) {
      const auto number = number_of(strings[size_t(i)]);
      are_numbers = are_numbers && number.has_value();
      axis[i] = number.value_or(0);
    }
    if (are_numbers && axis.length() > 0)
      along = placed_vector(material_.placed, axis).normalized();
  }
  if (along && u != v) {
    made.tangent = along;
  } else if (u != v) {
    approximated("its highlight is round: its direction is a function");
    u = v = std::sqrt(u * v);
  }
  if (material_.type() == "trans2")
    build_trans(made, spec, u, v, std::clamp(real(6, 0), 0.0, 1.0),
                std::clamp(real(7, 0), 0.0, 1.0));
  else
    build_plastic(made, material_.type() == "metal2", spec, u, v);
}

/// Even light by its shares; what the reals say comes on top.
void MaterialBuilder::build_measured(Appearance& made) {
  if (!measured_)
    return build_by_parts(made, 0, 6,
                          "its measured data cannot be read: its matt parts stay, or a sheet that "
                          "spreads half of the light behind it");
  approximated("it spreads light evenly, as much as its measured data do of light from all sides");
  const Rgb front = colour(0), through = colour(6);
  const auto sum = [](const Rgb& c, double share) {
    return Rgb{c.r + share, c.g + share, c.b + share};
  };
  const Rgb back = clamped(sum(front, measured_->reflected));
  const Rgb behind = clamped(sum(through, measured_->transmitted));
  const double most = std::max(largest_of(back) + largest_of(behind), 1.0);
  made.bsdf = make_object("bsdf", "thinphong", place_);
  paint(back).times(1 / most).put(*made.bsdf, "diffuse_reflectance");
  paint(behind).times(1 / most).put(*made.bsdf, "diffuse_transmittance");
}

/// Of three numbers from `reflected` on and of three from `transmitted` on.
void MaterialBuilder::build_by_parts(Appearance& made, size_t reflected, size_t transmitted,
                                     const char* why) {
  approximated(why);
  const bool has_none = material_.reals().size() < 3;
  const Rgb back = has_none ? Rgb{0.2, 0.2, 0.2} : colour(reflected);
  const Rgb through = has_none ? Rgb{0.5, 0.5, 0.5} : colour(transmitted);
  const double most = std::max(largest_of(back) + largest_of(through), 1.0);
  made.bsdf = make_object("bsdf", "thinphong", place_);
  paint(clamped(back)).times(1 / most).put(*made.bsdf, "diffuse_reflectance");
  paint(clamped(through)).times(1 / most).put(*made.bsdf, "diffuse_transmittance");
}

}  // namespace kaustik::radiance
