#include "kaustik/loader/mitsuba3_terms.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "kaustik/base/daylight_units.h"
#include "kaustik/base/error.h"
#include "kaustik/base/number_list.h"

namespace kaustik {
namespace {

/// What Mitsuba 3.7 has of the types that Kaustik has, by family; of families that are not here it
/// has all.
const std::map<std::string, std::set<std::string>>& types_of_mitsuba3() {
  static const std::map<std::string, std::set<std::string>> types = {
      {"shape",
       {"obj", "ply", "serialized", "rectangle", "cube", "sphere", "disk", "cylinder", "shapegroup",
        "instance", "merge", "sdfgrid"}},
      {"bsdf",
       {"diffuse", "dielectric", "roughdielectric", "thindielectric", "conductor", "roughconductor",
        "plastic", "roughplastic", "pplastic", "principled", "principledthin", "blendbsdf", "mask",
        "twosided", "bumpmap", "normalmap", "null"}},
      {"texture",
       {"bitmap", "checkerboard", "mesh_attribute", "volume", "blackbody", "d65", "regular",
        "irregular", "uniform", "srgb", "rawconstant"}},
      {"emitter",
       {"area", "directionalarea", "point", "spot", "projector", "directional", "constant",
        "envmap", "sunsky"}},
      {"sensor",
       {"perspective", "thinlens", "orthographic", "irradiancemeter", "radiancemeter", "distant",
        "batch"}},
      {"film", {"hdrfilm", "specfilm"}},
      {"rfilter", {"box", "tent", "gaussian", "mitchell", "catmullrom", "lanczos"}},
      {"sampler", {"independent", "stratified", "multijitter", "orthogonal", "ldsampler"}},
      {"integrator",
       {"direct", "path", "volpath", "volpathmis", "prb", "ptracer", "aov", "depth", "moment"}},
      {"medium", {"homogeneous", "heterogeneous"}},
      {"phase", {"isotropic", "hg", "rayleigh", "tabphase", "blendphase"}},
      {"volume", {"constvolume", "gridvolume"}}};
  return types;
}

/// Parameters that make a difference here and that Mitsuba 3 lacks; "" stands for all types.
struct OwnParameter {
  std::string_view family, type, name;
};
constexpr OwnParameter own_parameters[] = {{"bsdf", "dielectric", "priority"},
                                           {"bsdf", "conductor", "reflectance"},
                                           {"bsdf", "conductor", "edge_tint"},
                                           {"bsdf", "conductor", "ext_eta"},
                                           {"bsdf", "roughconductor", "reflectance"},
                                           {"bsdf", "roughconductor", "edge_tint"},
                                           {"bsdf", "roughconductor", "ext_eta"},
                                           {"texture", "bitmap", "gamma"},
                                           {"texture", "bitmap", "channel"},
                                           {"texture", "bitmap", "wrap_mode_u"},
                                           {"texture", "bitmap", "wrap_mode_v"},
                                           {"emitter", "area", "scale"},
                                           {"emitter", "area", "two_sided"},
                                           {"emitter", "spot", "falloff"},
                                           {"emitter", "envmap", "gamma"},
                                           {"emitter", "", "attenuation"},
                                           {"emitter", "", "visible"},
                                           {"sensor", "thinlens", "blades"},
                                           {"medium", "homogeneous", "material"}};

/// Parameters that change nothing here, though the light in them has a meaning there.
const std::set<std::string>& harmless_parameters() {
  static const std::set<std::string> names = {"accel",
                                              "complex_sun",
                                              "component_format",
                                              "compensate",
                                              "file_format",
                                              "focus_distance",
                                              "format",
                                              "has_spectral_extinction",
                                              "max_value",
                                              "mis_compensation",
                                              "pixel_format",
                                              "raw",
                                              "rr_depth",
                                              "sample_border",
                                              "sample_emitters",
                                              "sample_visible",
                                              "sampling_weight",
                                              "seed",
                                              "shutter_close",
                                              "shutter_open",
                                              "srf",
                                              "to_world",
                                              "unbounded",
                                              "use_grid_bbox",
                                              "jitter",
                                              "flip_invalid_normals"};
  return names;
}

Property* find_property(Object& object, std::string_view name) {
  for (Property& property : object.properties)
    if (property.name == name) return &property;
  return nullptr;
}

void remove_property(Object& object, std::string_view name) {
  std::erase_if(object.properties, [&](const Property& p) { return p.name == name; });
}

std::shared_ptr<Object> make_object(const char* family, const char* type, const Place& place) {
  return std::make_shared<Object>(Object{family, type, "", {}, {}, place});
}

std::optional<Rgb> colour_of(const Object& object, std::string_view name) {
  for (const Property& property : object.properties) {
    if (property.name != name) continue;
    if (const auto* colour = std::get_if<Rgb>(&property.value)) return *colour;
    if (const auto* number = std::get_if<double>(&property.value))
      return Rgb{*number, *number, *number};
  }
  return std::nullopt;
}

class Translator {
 public:
  Translator(const TypeTables& types, Mitsuba3Scene& result) : types_(types), result_(result) {}

  std::shared_ptr<Object> scene(const Object& scene) {
    has_media_ = holds_medium(scene);
    auto copy = std::make_shared<Object>(scene);
    for (Child& child : copy->children) child.object = translated(*child.object);
    return copy;
  }

 private:
  bool holds_medium(const Object& object) {
    if (object.family == "medium") return true;
    return visited_.insert(&object).second &&
           std::any_of(object.children.begin(), object.children.end(),
                       [&](const Child& child) { return holds_medium(*child.object); });
  }

  /// What several parents share they share afterwards, too.
  std::shared_ptr<Object> translated(const Object& object) {
    if (const auto known = copies_.find(&object); known != copies_.end()) return known->second;
    auto copy = std::make_shared<Object>(object);
    for (Child& child : copy->children) child.object = translated(*child.object);
    if (copy->type == "mixturebsdf") copy = as_blends(copy);
    change(*copy);
    return copies_[&object] = copy;
  }

  void change(Object& object) {
    if (object.family == "film") change_type(object, "hdrfilm");
    if (object.family == "sampler") change_type(object, "independent");
    if (object.family == "integrator") change_integrator(object);
    if (object.family == "medium" && object.type == "homogeneous") use_extinction(object);
    if (object.family == "emitter") use_sunsky(object);
    if (object.type == "rectangle" || object.type == "disk") give_depth(object);
    leave_out_parameters(object);
    name_what_is_unknown(object);
  }

  static bool has_type(const std::string& family, const std::string& type) {
    const auto known = types_of_mitsuba3().find(family);
    return known == types_of_mitsuba3().end() || known->second.contains(type);
  }

  void tell(const Object& object, const std::string& what) {
    if (told_.insert(what).second)
      result_.remarks.push_back(object.place.file ? text_of(object.place) + ": " + what : what);
  }

  /// Where Mitsuba 3 lacks the type; what the other type does not know is left out later.
  void change_type(Object& object, const char* type) {
    if (has_type(object.family, object.type)) return;
    tell(object, fmt::format("{} '{}' becomes '{}'", object.family, object.type, type));
    object.type = type;
  }

  void change_integrator(Object& object) {
    if (has_type(object.family, object.type)) return;
    change_type(object, has_media_ ? "volpath" : "path");
    object.children.clear();
    static const std::set<std::string> kept = {"max_depth", "rr_depth", "hide_emitters"};
    std::erase_if(object.properties, [](const Property& p) { return !kept.contains(p.name); });
  }

  /// A chain of blends, from the last bsdf backward; what weights lack of 1 is black.
  static std::shared_ptr<Object> as_blends(const std::shared_ptr<Object>& mixture) {
    std::vector<double> weights = {1};
    if (const Property* given = find_property(*mixture, "weights"))
      if (const auto* text = std::get_if<std::string>(&given->value))
        weights = parse_number_list(*text).numbers;
    const std::vector<const Child*> nested = ordered_children(*mixture, "bsdf");
    double sum = 0;
    for (const double weight : weights) sum += weight;
    const bool is_sound =
        std::all_of(weights.begin(), weights.end(), [](double weight) { return weight >= 0; });
    if (weights.size() != nested.size() || !is_sound || !(sum > 0)) return mixture;
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
    // One bsdf with all of the weight may be somebody else's, too.
    if (mixed->type == "blendbsdf" && mixed->id.empty()) mixed->id = mixture->id;
    return mixed;
  }

  static void use_extinction(Object& medium) {
    const auto scattering = colour_of(medium, "sigma_s"), absorption = colour_of(medium, "sigma_a");
    if (!scattering || !absorption) return;
    const Rgb s = *scattering, a = *absorption;
    const Rgb extinction{s.r + a.r, s.g + a.g, s.b + a.b};
    const auto share = [](double part, double all) { return all > 0 ? part / all : 0; };
    const Place place = find_property(medium, "sigma_s")->place;
    remove_property(medium, "sigma_s");
    remove_property(medium, "sigma_a");
    medium.properties.push_back({"sigma_t", extinction, place});
    medium.properties.push_back(
        {"albedo",
         Rgb{share(s.r, extinction.r), share(s.g, extinction.g), share(s.b, extinction.b)}, place});
  }

  /// Mitsuba 3 inverts to_world, and what lies in z = 0 stays the same whatever becomes of z.
  static void give_depth(Object& shape) {
    Property* property = find_property(shape, "to_world");
    auto* to_world = property ? std::get_if<Transform>(&property->value) : nullptr;
    if (!to_world || to_world->dimensions() != 2) return;
    const auto column = [&](int j) {
      return Vec3d(to_world->at(0, j), to_world->at(1, j), to_world->at(2, j));
    };
    const Vec3d normal = column(0).cross(column(1));
    double rows[4][4];
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) rows[i][j] = to_world->at(i, j);
    for (int i = 0; i < 3; ++i) rows[i][2] = normal.length() > 0 ? normal[i] / normal.length() : 0;
    *to_world = Transform::collapsing(rows);
  }

  void use_sunsky(Object& emitter) {
    if (emitter.type != "sun" && emitter.type != "sky" && emitter.type != "sunsky") return;
    result_.version = "3.7.0";  // the first that has it, and means units of Mitsuba
    const Property* units = find_property(emitter, "units");
    const auto* name = units ? std::get_if<std::string>(&units->value) : nullptr;
    const double factor = name && *name == "mitsuba" ? 1 : 1 / mitsuba_daylight;
    remove_property(emitter, "units");
    scale(emitter, "sun_scale", emitter.type == "sky" ? 0 : factor);
    scale(emitter, "sky_scale", emitter.type == "sun" ? 0 : factor);
    if (emitter.type != "sunsky")
      tell(emitter, fmt::format("emitter '{}' becomes 'sunsky'", emitter.type));
    emitter.type = "sunsky";
  }

  static void scale(Object& emitter, const char* name, double factor) {
    Property* given = find_property(emitter, name);
    auto* number = given ? std::get_if<double>(&given->value) : nullptr;
    if (number)
      *number *= factor;
    else if (!given && factor != 1)
      emitter.properties.push_back({name, factor, emitter.place});
  }

  /// Unknown here, or without effect, and an error there.
  void leave_out_parameters(Object& object) {
    const TypeInfo* info = types_.find(object.family, object.type);
    if (!info) return;
    std::erase_if(object.properties, [&](const Property& property) {
      const Parameter* row = info->find(property.name);
      const bool stays =
          row ? !row->no_effect || harmless_parameters().contains(property.name) : false;
      if (!stays)
        tell(object,
             fmt::format("'{}' of {} '{}' is left out", property.name, object.family, object.type));
      return !stays;
    });
  }

  void name_what_is_unknown(const Object& object) {
    if (!has_type(object.family, object.type)) {
      tell(object, fmt::format("Mitsuba 3 has no {} '{}'", object.family, object.type));
      return;
    }
    for (const Property& property : object.properties)
      for (const OwnParameter& own : own_parameters)
        if (own.family == object.family && (own.type.empty() || own.type == object.type) &&
            own.name == property.name)
          tell(object, fmt::format("Mitsuba 3 has no '{}' in {} '{}'", property.name, object.family,
                                   object.type));
  }

  const TypeTables& types_;
  Mitsuba3Scene& result_;
  bool has_media_ = false;
  std::set<const Object*> visited_;
  std::map<const Object*, std::shared_ptr<Object>> copies_;
  std::set<std::string> told_;
};

}  // namespace

Mitsuba3Scene in_terms_of_mitsuba3(const Description& description, const TypeTables& types) {
  Mitsuba3Scene result{description, "3.0.0", {}};
  result.description.scene = Translator(types, result).scene(*description.scene);
  return result;
}

}  // namespace kaustik
