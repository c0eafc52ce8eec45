// The materials that let light through or emit it.

#include <algorithm>
#include <cmath>

#include "kaustik/loader/radiance/material_builder.h"
#include "kaustik/loader/radiance/placement.h"

namespace kaustik::radiance {

/// By transmissivity: what passes once through the pane between its two sides. With reflection r at
/// each side and transmissivity t the pane transmits (1 − r)² t / (1 − r² t²) and reflects
/// r + r (1 − r)² t² / (1 − r² t²); a clear one (1 − r) / (1 + r) and 2 r / (1 + r).
void MaterialBuilder::build_glass(Appearance& made) {
  const double index = std::clamp(real(3, 1.52), 1.0, 100.0);
  const double r = std::pow((index - 1) / (index + 1), 2);
  const Rgb t = clamped(colour(0, 1));
  const auto transmitted = [&](double x) {
    return (1 - r) * (1 - r) * x / (1 - r * r * x * x) * (1 + r) / (1 - r);
  };
  const auto reflected = [&](double x) {
    if (r == 0) return 1.0;
    return (r + r * (1 - r) * (1 - r) * x * x / (1 - r * r * x * x)) * (1 + r) / (2 * r);
  };
  const ObjectPointer pane = make_object("bsdf", "thindielectric", place_);
  give(*pane, "int_ior", index);
  give(*pane, "ext_ior", 1.0);
  give(*pane, "specular_reflectance", Rgb{reflected(t.r), reflected(t.g), reflected(t.b)});
  paint(Rgb{transmitted(t.r), transmitted(t.g), transmitted(t.b)})
      .put(*pane, "specular_transmittance");
  if (std::min({t.r, t.g, t.b}) < 0.8)
    approximated(
        "its tint stays as it is at normal incidence, where Radiance's glass grows darker "
        "toward grazing angles");
  made.bsdf = pane;
}

ObjectPointer MaterialBuilder::absorption(const Rgb& transmission) const {
  if (std::min({transmission.r, transmission.g, transmission.b}) >= 1) return nullptr;
  // Per unit of length of the file's space.
  const double scale = scale_of(material_.placed);
  const auto coefficient = [&](double t) { return -std::log(std::clamp(t, 1e-12, 1.0)) / scale; };
  const ObjectPointer medium = make_object("medium", "homogeneous", place_);
  give(*medium, "sigma_a",
       Rgb{coefficient(transmission.r), coefficient(transmission.g), coefficient(transmission.b)});
  give(*medium, "sigma_s", Rgb{0, 0, 0});
  return medium;
}

void MaterialBuilder::build_dielectric(Appearance& made) {
  made.bsdf = make_object("bsdf", "dielectric", place_);
  give(*made.bsdf, "int_ior", std::clamp(real(3, 1.5), 0.01, 100.0));
  give(*made.bsdf, "ext_ior", 1.0);
  made.interior = absorption(product(colour(0, 1), tint_.factor));
  if (real(4, 0) != 0) ignored("its dispersion is left out (Hartmann's constant)");
  if (tint_.is_textured()) ignored("the pattern in it is left out");
}

void MaterialBuilder::build_interface(Appearance& made) {
  made.bsdf = make_object("bsdf", "dielectric", place_);
  give(*made.bsdf, "int_ior", std::clamp(real(3, 1.5), 0.01, 100.0));
  give(*made.bsdf, "ext_ior", std::clamp(real(7, 1), 0.01, 100.0));
  made.interior = absorption(colour(0, 1));
  made.exterior = absorption(colour(4, 1));
  if (tint_.is_textured()) ignored("the pattern in it is left out");
}

Rgb MaterialBuilder::emitted() const {
  const Rgb radiance = product(colour(0), tint_.factor);
  return {std::max(radiance.r, 0.0), std::max(radiance.g, 0.0), std::max(radiance.b, 0.0)};
}

void MaterialBuilder::build_light(Appearance& made, bool is_visible) {
  made.bsdf = is_visible ? matt(Paint(Rgb{0, 0, 0}), place_) : make_object("bsdf", "null", place_);
  if (largest_of(emitted()) <= 0) return;
  if (const std::string remark = luminance_remark(emitted()); !remark.empty()) approximated(remark);
  made.emitter = make_object("emitter", "area", place_);
  // Pictures on lamps shine; the emission may exceed 1.
  Paint(emitted(), tint_.picture ? texture_ : nullptr).put(*made.emitter, "radiance");
  if (!is_visible) give(*made.emitter, "visible", false);
  if (!tint_.directed.empty())
    made.directed = DirectedLight{product(colour(0), tint_.even_factor), tint_.directed};
  if (material_.type() != "glow") return;
  const double reach = real(3, 0);
  if (reach < 0)
    approximated("it lights the scene, where in Radiance it is only seen");
  else if (reach > 0)
    approximated("it lights everything, where in Radiance it lights what is near");
}

void MaterialBuilder::build_spotlight(Appearance& made) {
  made.bsdf = matt(Paint(Rgb{0, 0, 0}), place_);
  const Vec3d axis = placed_vector(material_.placed, Vec3d(real(4, 0), real(5, 0), real(6, -1)));
  if (!(axis.length() > 0) || largest_of(emitted()) <= 0) return;
  made.beam = Appearance::Beam{emitted(), std::clamp(real(3, 0), 0.0, 360.0), axis.normalized()};
  approximated("its light comes from a point in the middle of its surface, which itself is dark");
  if (!tint_.directed.empty()) approximated("its pattern counts by its mean");
}

void MaterialBuilder::build_mirror(Appearance& made) {
  made.bsdf = two_sided(perfect_mirror(paint(colour(0)), place_));
  if (!material_.strings().empty() && material_.strings()[0] != "void")
    ignored("its alternate material is left out: it is a mirror to all rays");
}

void MaterialBuilder::build_mist(Appearance& made) {
  made.bsdf = make_object("bsdf", "null", place_);
  const double scale = scale_of(material_.placed);
  const size_t n = material_.reals().size();
  if (n < 3) {
    ignored("its extinction is an option of the renderer, and unknown: there is no mist");
    return;
  }
  const Rgb extinction = colour(0);
  made.interior = make_object("medium", "homogeneous", place_);
  give(
      *made.interior, "sigma_t",
      times({std::max(extinction.r, 0.0), std::max(extinction.g, 0.0), std::max(extinction.b, 0.0)},
            1 / scale));
  give(*made.interior, "albedo", clamped(n >= 6 ? colour(3) : Rgb{0, 0, 0}));
  const ObjectPointer phase = make_object("phase", "hg", place_);
  give(*phase, "g", std::clamp(real(6, 0), -0.99, 0.99));
  nest(*made.interior, phase);
}

}  // namespace kaustik::radiance
