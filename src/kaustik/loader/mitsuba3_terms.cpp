#include "kaustik/loader/mitsuba3_terms.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "kaustik/base/daylight_units.h"
#include "kaustik/base/snake_case.h"
#include "kaustik/loader/mitsuba3_rewrites.h"
#include "kaustik/loader/mitsuba3_textures.h"
#include "kaustik/loader/mitsuba3_types.h"
#include "kaustik/loader/object_parts.h"

namespace kaustik {
namespace {

class Translator {
 public:
  Translator(const TypeTables& types, const std::string& scene_file, Mitsuba3Scene& result)
      : types_(types), result_(result), scaling_(types), files_(scene_file) {}

  std::shared_ptr<Object> scene(const Object& scene) {
    has_media_ = holds_medium(scene);
    auto copy = std::make_shared<Object>(scene);
    for (Child& child : copy->children) child.object = translated(*child.object);
    std::set<const Object*> seen;
    finish(copy, seen);
    result_.files = files_.take();
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
    spell_in_snake_case(*copy);
    if (copy->family == "shape") sources_[copy.get()] = *copy;
    for (Child& child : copy->children) child.object = translated(*child.object);
    if (copy->type == "mixturebsdf") copy = mixture_as_blends(copy);
    if (copy->type == "mixturephase") copy = mixture_as_phases(copy);
    change(*copy);
    return copies_[&object] = copy;
  }

  /// Parameters in camelCase, which Kaustik takes for those in snake_case that it knows.
  void spell_in_snake_case(Object& object) const {
    const TypeInfo* info = types_.find(object.family, object.type);
    if (!info) return;
    for (Property& property : object.properties) {
      const std::string snake = snake_case_from_camel_case(property.name);
      if (!info->find(property.name) && info->find(snake) && !find_property(object, snake))
        property.name = snake;
    }
  }

  void change(Object& object) {
    if (object.family == "film") change_type(object, "hdrfilm");
    if (object.family == "sampler") change_type(object, "independent");
    if (object.family == "integrator") change_integrator(object);
    if (object.family == "medium" && object.type == "homogeneous") use_extinction(object);
    if (object.family == "emitter") change_emitter(object);
    if (object.family == "sensor") change_sensor(object);
    if (object.family == "bsdf") change_bsdf(object);
    if (object.family == "texture" && object.type == "bitmap") use_bitmap_terms(object);
    if (object.type == "rectangle" || object.type == "disk") give_depth(object);
    scaling_.apply_to(object);
    leave_out_parameters(object);
  }

  void change_emitter(Object& emitter) {
    if (emitter.type == "area") scaling_.use_radiance_of_lamp(emitter);
    use_sunsky(emitter);
  }

  void change_sensor(Object& sensor) {
    use_orthographic(sensor);
    if (sensor.type == "perspective_rdist") change_type(sensor, "perspective");
  }

  static void change_bsdf(Object& bsdf) {
    use_diffuse(bsdf);
    use_thin_sheet(bsdf);
    use_relative_eta(bsdf);
    use_known_distribution(bsdf);
  }

  /// Files to write, and what is left that Mitsuba 3 has no word for.
  void finish(const std::shared_ptr<Object>& object, std::set<const Object*>& seen) {
    if (!seen.insert(object.get()).second) return;
    if (object->family == "shape" && needs_ply(*object))
      files_.use_ply(object, sources_.at(object.get()));
    if (object->family == "texture" && object->type == "bitmap") {
      const Rgb factor = scaling_.factor_of(*object);
      if (factor != Rgb{1, 1, 1} || needs_exr(*object)) files_.use_exr(object, factor);
    }
    if (object->type == "envmap" && find_property(*object, "data")) files_.use_exr_around(object);
    if (object->family == "volume" && find_property(*object, "data")) files_.use_vol(object);
    if (object->family != "scene") name_what_is_unknown(*object);
    for (const Child& child : object->children) finish(child.object, seen);
  }

  static bool needs_exr(const Object& bitmap) {
    if (find_property(bitmap, "data")) return true;
    const auto gamma = number_in(bitmap, "gamma");
    const auto* channel = value_in<std::string>(bitmap, "channel");
    return value_in<std::string>(bitmap, "filename") &&
           ((gamma && *gamma != 0) || (channel && !channel->empty()) ||
            find_property(bitmap, "invert") || find_property(bitmap, "power"));
  }

  /// Whether Mitsuba 3 would not read the mesh as Kaustik does.
  bool needs_ply(const Object& shape) {
    if (shape.type == "heightfield" || shape.type == "mesh") return true;
    const bool is_obj = shape.type == "obj", is_serialized = shape.type == "serialized";
    if ((!is_obj && !is_serialized && shape.type != "ply") ||
        !value_in<std::string>(shape, "filename"))
      return false;
    const auto* index = value_in<int64_t>(shape, "shape_index");
    const auto* flips = value_in<bool>(shape, "flip_tex_coords");
    // It reads no colours but those of PLY files.
    return find_property(shape, "max_smooth_angle") || find_property(shape, "material") ||
           find_property(shape, "front_by_normals") || (is_obj && index && *index >= 0) ||
           (is_serialized && flips && *flips) || (shape.type != "ply" && asks_attribute(shape));
  }

  bool asks_attribute(const Object& object) {
    if (object.family == "texture" && object.type == "mesh_attribute") return true;
    const auto [known, is_new] = asks_attribute_.try_emplace(&object, false);
    if (!is_new) return known->second;
    const bool asks =
        std::any_of(object.children.begin(), object.children.end(),
                    [&](const Child& child) { return asks_attribute(*child.object); });
    return asks_attribute_[&object] = asks;
  }

  void tell(const Object& object, const std::string& what) {
    if (told_.insert(what).second)
      result_.remarks.push_back(object.place.file ? text_of(object.place) + ": " + what : what);
  }

  /// Where Mitsuba 3 lacks the type; what the other type does not know is left out later.
  void change_type(Object& object, const char* type, const char* consequence = "") {
    if (mitsuba3_has_type(object.family, object.type)) return;
    tell(object,
         fmt::format("{} '{}' becomes '{}'{}", object.family, object.type, type, consequence));
    object.type = type;
  }

  void change_integrator(Object& object) {
    if (mitsuba3_has_type(object.family, object.type)) return;
    change_type(object, has_media_ ? "volpath" : "path",
                ", which misses caustics of point, spot and directional lamps");
    object.children.clear();
    static const std::set<std::string> kept = {"max_depth", "rr_depth", "hide_emitters"};
    std::erase_if(object.properties, [](const Property& p) { return !kept.contains(p.name); });
  }

  void use_sunsky(Object& emitter) {
    if (emitter.type != "sun" && emitter.type != "sky" && emitter.type != "sunsky") return;
    if (find_property(emitter, "irradiance")) return;  // there it is by turbidity alone
    result_.version = "3.7.0";  // the first that has it, and means units of Mitsuba
    const Property* units = find_property(emitter, "units");
    const auto* name = units ? std::get_if<std::string>(&units->value) : nullptr;
    const double factor = name && *name == "mitsuba" ? 1 : 1 / mitsuba_daylight;
    remove_property(emitter, "units");
    multiply_number(emitter, "sun_scale", emitter.type == "sky" ? 0 : factor);
    multiply_number(emitter, "sky_scale", emitter.type == "sun" ? 0 : factor);
    if (emitter.type != "sunsky")
      tell(emitter, fmt::format("emitter '{}' becomes 'sunsky'", emitter.type));
    emitter.type = "sunsky";
  }

  /// Unknown here, or without effect, and an error there.
  void leave_out_parameters(Object& object) {
    const TypeInfo* info = types_.find(object.family, object.type);
    if (!info) return;
    std::erase_if(object.properties, [&](const Property& property) {
      const Parameter* row = info->find(property.name);
      const bool stays = row && (!row->no_effect || is_known_to_mitsuba3(property.name)) &&
                         !may_be_left_out(object.family, property.name);
      if (!stays)
        tell(object, fmt::format("'{}' of {} '{}' is left out", property.spelling(), object.family,
                                 object.type));
      return !stays;
    });
  }

  void name_what_is_unknown(const Object& object) {
    if (!mitsuba3_has_type(object.family, object.type)) {
      tell(object, fmt::format("Mitsuba 3 has no {} '{}'", object.family, object.type));
      return;
    }
    for (const Property& property : object.properties)
      if (const LackingInMitsuba3* row = lacking_in_mitsuba3(object.family, object.type, property))
        tell(object, fmt::format("Mitsuba 3 has no '{}' in {} '{}'",
                                 row->values.empty() ? property.name
                                                     : property.name + "' '" +
                                                           std::get<std::string>(property.value),
                                 object.family, object.type));
  }

  const TypeTables& types_;
  Mitsuba3Scene& result_;
  bool has_media_ = false;
  std::set<const Object*> visited_;
  std::map<const Object*, std::shared_ptr<Object>> copies_;
  std::map<const Object*, Object> sources_;  ///< what shapes were, with names in snake_case
  std::map<const Object*, bool> asks_attribute_;
  std::set<std::string> told_;
  TextureScaling scaling_;
  FilesToWrite files_;
};

}  // namespace

Mitsuba3Scene in_terms_of_mitsuba3(const Description& description, const TypeTables& types,
                                   const std::string& scene_file) {
  Mitsuba3Scene result{description, "3.0.0", {}, {}};
  result.description.scene = Translator(types, scene_file, result).scene(*description.scene);
  return result;
}

}  // namespace kaustik
