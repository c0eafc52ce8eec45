#include "kaustik/loader/nori/materials.h"

#include <fmt/format.h>

#include <algorithm>

#include "kaustik/loader/object_maker.h"
#include "kaustik/loader/object_parts.h"

namespace kaustik::nori {
namespace {

constexpr double glass_ior = 1.5046, air_ior = 1.000277;

/// A bsdf that is read, and what becomes of it.
class MaterialReader {
 public:
  MaterialReader(const Object& element, Reading& reading)
      : element_(element), reading_(reading), given_(element, reading.deviations) {}

  std::shared_ptr<Object> read() {
    auto bsdf = read_type();
    reading_.ignore_parts(element_, taken_);
    return bsdf;
  }

 private:
  std::shared_ptr<Object> read_type() {
    const std::string& type = element_.type;
    if (type == "diffuse") return coloured("diffuse", "reflectance");
    if (type == "mirror") return started("conductor");
    if (type == "dielectric") return dielectric("dielectric");
    if (type == "microfacet") return microfacet();
    if (type == "phong") return phong();
    if (type == "null") return started("null");
    if (type == "roughdielectric" || type == "rough_dielectric") return rough_dielectric();
    if (type == "conductor") return metal("conductor");
    if (type == "roughconductor" || type == "rough_conductor") return metal("roughconductor");
    if (type.starts_with("disney") || type.starts_with("principled")) return principled();
    return stand_in();
  }

  std::shared_ptr<Object> started(const char* type) const {
    return make_object("bsdf", type, element_.place);
  }

  /// A colour, or the texture that stands for it; false: neither is given.
  bool give_colour(Object& bsdf, const char* name, Given::Names theirs) {
    for (const Child& child : element_.children) {
      if (child.object->family != "texture") continue;
      if (!child.name.empty() && std::ranges::find(theirs, plain_name(child.name)) == theirs.end())
        continue;
      taken_.insert(child.object.get());
      auto texture = texture_of(*child.object, reading_);
      if (!texture) continue;
      put(bsdf, name, std::move(texture));
      return true;
    }
    const auto colour = given_.colour(theirs);
    if (colour) give(bsdf, name, *colour);
    return colour.has_value();
  }

  std::shared_ptr<Object> coloured(const char* type, const char* name) {
    auto bsdf = started(type);
    if (!give_colour(*bsdf, name, {"albedo", "kd", "reflectance", "basecolor", "color"}))
      give(*bsdf, name, 0.5);
    return bsdf;
  }

  std::shared_ptr<Object> dielectric(const char* type) {
    auto bsdf = started(type);
    give(*bsdf, "int_ior", given_.number({"intior"}).value_or(glass_ior));
    give(*bsdf, "ext_ior", given_.number({"extior"}).value_or(air_ior));
    return bsdf;
  }

  std::shared_ptr<Object> rough_dielectric() {
    auto bsdf = dielectric("roughdielectric");
    give(*bsdf, "alpha", given_.number({"alpha"}).value_or(0.1));
    give(*bsdf, "distribution", "beckmann");
    return bsdf;
  }

  /// f = kd/π + ks·D·F·G/(4 cosθi cosθo) with ks = 1 − max kd. A blend by ks of both parts is that
  /// sum, and its parts reflect at most all.
  std::shared_ptr<Object> microfacet() {
    Rgb kd = given_.colour({"kd"}).value_or(Rgb{0.5, 0.5, 0.5});
    const double most = std::max({kd.r, kd.g, kd.b});
    const double ks = std::clamp(1 - most, 0.0, 1.0);
    auto facets = started("roughconductor");
    const double eta = given_.number({"intior"}).value_or(glass_ior) /
                       std::max(1e-3, given_.number({"extior"}).value_or(air_ior));
    give(*facets, "distribution", "beckmann");
    give(*facets, "alpha", given_.number({"alpha"}).value_or(0.1));
    give(*facets, "eta", Rgb{eta, eta, eta});
    give(*facets, "k", Rgb{0, 0, 0});
    if (ks == 1) return facets;
    if (most > 1)
      reading_.approximated(element_, "it would reflect more than all light: kd is scaled to 1");
    const auto base = matt({kd.r / most, kd.g / most, kd.b / most}, element_.place);
    if (ks == 0) return base;
    auto blend = started("blendbsdf");
    give(*blend, "weight", ks);
    put(*blend, "", base);
    put(*blend, "", facets);
    return blend;
  }

  std::shared_ptr<Object> phong() {
    auto bsdf = coloured("phong", "diffuse_reflectance");
    give_colour(*bsdf, "specular_reflectance", {"ks", "specular"});
    if (const auto exponent = given_.number({"exponent", "n", "shininess"}))
      give(*bsdf, "exponent", *exponent);
    reading_.approximated(element_, "Phong models differ: it becomes the modified one");
    return bsdf;
  }

  std::shared_ptr<Object> metal(const char* type) {
    auto bsdf = started(type);
    if (type == std::string_view("roughconductor")) {
      give(*bsdf, "alpha", given_.number({"alpha", "roughness"}).value_or(0.1));
      give(*bsdf, "distribution", "beckmann");
    }
    const auto eta = given_.colour({"eta"}), k = given_.colour({"k"});
    if (eta && k) {
      give(*bsdf, "eta", *eta);
      give(*bsdf, "k", *k);
    } else if (const auto metal_name = given_.text({"material", "materialname"})) {
      give(*bsdf, "material", *metal_name);
    }
    return bsdf;
  }

  std::shared_ptr<Object> principled() {
    auto bsdf = coloured("principled", "base_color");
    const std::pair<const char*, const char*> numbers[] = {{"metallic", "metallic"},
                                                           {"roughness", "roughness"},
                                                           {"specular", "specular"},
                                                           {"speculartint", "spec_tint"},
                                                           {"sheen", "sheen"},
                                                           {"sheentint", "sheen_tint"},
                                                           {"clearcoat", "clearcoat"},
                                                           {"clearcoatgloss", "clearcoat_gloss"},
                                                           {"anisotropic", "anisotropic"},
                                                           {"subsurface", "flatness"}};
    for (const auto& [theirs, ours] : numbers)
      if (const auto number = given_.number({theirs})) give(*bsdf, ours, *number);
    reading_.approximated(element_, "its model becomes Burley's of Mitsuba");
    return bsdf;
  }

  /// What is in it, or a matt surface of its colour.
  std::shared_ptr<Object> stand_in() {
    for (const Child& child : element_.children)
      if (child.object->family == "bsdf") {
        reading_.approximated(element_, "there is no such bsdf here: the one in it stands for it");
        taken_.insert(child.object.get());
        return bsdf_of(*child.object, reading_);
      }
    reading_.approximated(element_, "there is no such bsdf here: it is matt");
    return coloured("diffuse", "reflectance");
  }

  const Object& element_;
  Reading& reading_;
  Given given_;
  std::set<const Object*> taken_;  ///< parts of the element
};

}  // namespace

std::shared_ptr<Object> bsdf_of(const Object& element, Reading& reading) {
  return MaterialReader(element, reading).read();
}

std::shared_ptr<Object> matt(const Rgb& reflectance, const Place& place) {
  auto bsdf = make_object("bsdf", "diffuse", place);
  give(*bsdf, "reflectance", reflectance);
  return bsdf;
}

std::shared_ptr<Object> usual_bsdf(const Place& place) { return matt({0.5, 0.5, 0.5}, place); }

}  // namespace kaustik::nori
