#include "kaustik/loader/mitsuba3_rewrites.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include "kaustik/base/mixture_weights.h"
#include "kaustik/loader/object_parts.h"

namespace kaustik {
namespace {

std::shared_ptr<Object> make_object(const char* family, const char* type, const Place& place) {
  return std::make_shared<Object>(Object{family, type, "", {}, {}, place});
}

/// None where they are wrong. Without any, a mixture of bsdfs has 1.
std::vector<double> weights_of(const Object& mixture, size_t count) {
  const Property* given = find_property(mixture, "weights");
  const std::string usual = mixture.family == "bsdf" ? "1" : "";
  return mixture_weights(given ? given->value : Value(usual), count, "parts").numbers;
}

/// What stands for a mixture has its name.
std::shared_ptr<Object> named_after(const Object& mixture, std::shared_ptr<Object> mixed,
                                    std::string_view blend) {
  // One part with all of the weight may be somebody else's, too.
  if (mixed->type == blend && mixed->id.empty()) mixed->id = mixture.id;
  return mixed;
}

bool has_child(const Object& object, std::string_view name) {
  return std::ranges::find(object.children, name, &Child::name) != object.children.end();
}

/// Whether the parameter says 0, and no texture stands instead.
bool is_zero(const Object& object, std::string_view name) {
  const auto colour = colour_in(object, name);
  return colour == Rgb{0, 0, 0} && !has_child(object, name);
}

void rename(Object& object, std::string_view name, const char* as) {
  for (Property& property : object.properties)
    if (property.name == name) property.name = as;
  for (Child& child : object.children)
    if (child.name == name) child.name = as;
}

/// Leaves nothing but one parameter.
void keep_only(Object& object, std::string_view name) {
  std::erase_if(object.properties, [&](const Property& p) { return p.name != name; });
  std::erase_if(object.children, [&](const Child& child) { return child.name != name; });
}

void divide(Value& value, double by) {
  change_numbers(value, [&](double number) { return number / by; });
}

}  // namespace

std::shared_ptr<Object> mixture_as_blends(const std::shared_ptr<Object>& mixture) {
  const std::vector<const Child*> nested = ordered_children(*mixture, "bsdf");
  const std::vector<double> weights = weights_of(*mixture, nested.size());
  if (weights.empty()) return mixture;
  double sum = 0;
  for (const double weight : weights) sum += weight;
  const double whole = std::max(sum, 1.0);
  std::shared_ptr<Object> mixed;
  double share = 1 - sum / whole;
  if (share > 1e-6) {
    mixed = make_object("bsdf", "diffuse", mixture->place);
    mixed->properties = {{"reflectance", 0.0, mixture->place}};
  } else {
    share = 0;
  }
  for (size_t i = nested.size(); i-- > 0;) {
    const double weight = weights[i] / whole;
    if (weight == 0) continue;
    share += weight;
    if (!mixed) {
      mixed = nested[i]->object;
      continue;
    }
    const auto blend = make_object("bsdf", "blendbsdf", mixture->place);
    blend->properties = {{"weight", 1 - weight / share, mixture->place}};
    blend->children = {{"", nested[i]->object}, {"", mixed}};
    mixed = blend;
  }
  return named_after(*mixture, mixed, "blendbsdf");
}

std::shared_ptr<Object> mixture_as_phases(const std::shared_ptr<Object>& mixture) {
  constexpr size_t most_nested = 4;
  std::vector<std::shared_ptr<Object>> nested;
  for (const Child& child : mixture->children)
    if (child.object->family == "phase") nested.push_back(child.object);
  const std::vector<double> weights = weights_of(*mixture, nested.size());
  if (weights.empty() || nested.size() > most_nested) return mixture;
  std::shared_ptr<Object> mixed = nested[0];
  double sum = weights[0];
  for (size_t i = 1; i < nested.size(); ++i) {
    sum += weights[i];
    const auto blend = make_object("phase", "blendphase", mixture->place);
    blend->properties = {{"weight", sum > 0 ? weights[i] / sum : 0, mixture->place}};
    blend->children = {{"", mixed}, {"", nested[i]}};
    mixed = blend;
  }
  return named_after(*mixture, mixed, "blendphase");
}

void use_diffuse(Object& bsdf) {
  const bool is_matt =
      ((bsdf.type == "phong" || bsdf.type == "ward") && is_zero(bsdf, "specular_reflectance")) ||
      (bsdf.type == "roughdiffuse" && (is_zero(bsdf, "alpha") || is_zero(bsdf, "roughness")));
  if (!is_matt) return;
  bsdf.type = "diffuse";
  rename(bsdf, "diffuse_reflectance", "reflectance");
  keep_only(bsdf, "reflectance");
}

void use_thin_sheet(Object& bsdf) {
  if (bsdf.type != "difftrans") return;
  bsdf.type = "principledthin";
  rename(bsdf, "transmittance", "base_color");
  keep_only(bsdf, "base_color");
  constexpr double all = 2;  // half of it is reflected at 1
  bsdf.properties.push_back({"diff_trans", all, bsdf.place});
}

void use_relative_eta(Object& bsdf) {
  constexpr double air = 1.000277;
  std::optional<double> outside = number_in(bsdf, "ext_eta");
  if (const auto* name = value_in<std::string>(bsdf, "ext_eta"))
    outside = *name == "air"      ? std::optional(air)
              : *name == "vacuum" ? std::optional(1.0)
                                  : outside;
  if (!outside || !(*outside > 0)) return;
  Property *eta = find_property(bsdf, "eta"), *k = find_property(bsdf, "k");
  if (*outside != 1 && (!eta || !k || has_child(bsdf, "eta") || has_child(bsdf, "k"))) return;
  if (eta) divide(eta->value, *outside);
  if (k) divide(k->value, *outside);
  remove_property(bsdf, "ext_eta");
}

void use_known_distribution(Object& bsdf) {
  Property* given = find_property(bsdf, "distribution");
  auto* name = given ? std::get_if<std::string>(&given->value) : nullptr;
  if (name && (*name == "phong" || *name == "as")) *name = "beckmann";
}

void use_bitmap_terms(Object& bitmap) {
  if (number_in(bitmap, "gamma") == 1.0) {
    const Property before = *find_property(bitmap, "gamma");
    remove_property(bitmap, "gamma");
    remove_property(bitmap, "raw");
    bitmap.properties.push_back({"raw", true, before.place});
  }
  const auto *along_u = value_in<std::string>(bitmap, "wrap_mode_u"),
             *along_v = value_in<std::string>(bitmap, "wrap_mode_v");
  if (!along_u || !along_v || *along_u != *along_v) return;
  const Property same{"wrap_mode", *along_u, find_property(bitmap, "wrap_mode_u")->place};
  for (const char* name : {"wrap_mode", "wrap_mode_u", "wrap_mode_v"})
    remove_property(bitmap, name);
  bitmap.properties.push_back(same);
}

void use_extinction(Object& medium) {
  const auto scattering = colour_in(medium, "sigma_s"), absorption = colour_in(medium, "sigma_a");
  if (!scattering || !absorption) return;
  const Rgb s = *scattering, a = *absorption;
  const Rgb extinction{s.r + a.r, s.g + a.g, s.b + a.b};
  const auto share = [](double part, double all) { return all > 0 ? part / all : 0; };
  const Place place = find_property(medium, "sigma_s")->place;
  remove_property(medium, "sigma_s");
  remove_property(medium, "sigma_a");
  medium.properties.push_back({"sigma_t", extinction, place});
  medium.properties.push_back(
      {"albedo", Rgb{share(s.r, extinction.r), share(s.g, extinction.g), share(s.b, extinction.b)},
       place});
}

void give_depth(Object& flat_shape) {
  auto* to_world = value_in<Transform>(flat_shape, "to_world");
  if (!to_world || to_world->dimensions() != 2) return;
  const auto column = [&](int j) {
    return Vec3d(to_world->at(0, j), to_world->at(1, j), to_world->at(2, j));
  };
  const Vec3d normal = column(0).cross(column(1));
  double rows[4][4];
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) rows[i][j] = to_world->at(i, j);
  for (int i = 0; i < 3; ++i) rows[i][2] = normal.length() > 0 ? normal[i] / normal.length() : 0;
  find_property(flat_shape, "to_world")->value = Transform::collapsing(rows);
}

void use_orthographic(Object& sensor) {
  if (sensor.type != "telecentric") return;
  if (find_property(sensor, "aperture_radius") && number_in(sensor, "aperture_radius") != 0.0)
    return;
  sensor.type = "orthographic";
  for (const char* name : {"aperture_radius", "blades", "blade_rotation"})
    remove_property(sensor, name);
}

}  // namespace kaustik
