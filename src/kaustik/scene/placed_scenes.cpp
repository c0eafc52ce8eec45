#include "kaustik/scene/placed_scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "kaustik/light/light.h"
#include "kaustik/scene/merged_shapes.h"
#include "kaustik/scene/type_tables.h"

namespace kaustik {
namespace {

constexpr int maximum_levels = 64;
constexpr size_t maximum_placements = 1'000'000;
constexpr size_t maximum_lamps = 100'000;  ///< each is a light of its own, unlike other shapes

bool is_shape(const Object& object, const char* type) {
  return object.family == "shape" && object.type == type;
}
bool shines(const Object& object) {
  return object.family == "shape" &&
         std::any_of(object.children.begin(), object.children.end(),
                     [](const Child& child) { return child.object->family == "emitter"; });
}
/// Only there for others to refer to, which have it already.
bool is_definition(const Object& object) {
  return object.family == "bsdf" || object.family == "texture" || object.family == "medium" ||
         object.family == "volume" || is_shape(object, "shapegroup");
}
bool is_of_whole_picture(const Object& object) {
  return object.family == "sensor" || object.family == "integrator";
}
/// What a group may hold as far as the scene builder goes, mistakes included: it will tell them.
bool stays_in_group(const Object& object) {
  return !is_definition(object) && !is_of_whole_picture(object) && object.family != "emitter" &&
         !is_shape(object, "instance") && !shines(object);
}

const Property* find_property(const Object& object, const std::string& name) {
  for (const Property& property : object.properties)
    if (property.name == name) return &property;
  return nullptr;
}
void set_property(Object& object, const std::string& name, const Value& value) {
  const Property* old = find_property(object, name);
  const Place place = old ? old->place : object.place;
  std::erase_if(object.properties, [&](const Property& p) { return p.name == name; });
  object.properties.push_back({name, value, place});
}

/// The value of a property if it has the type; null if not, which will be told when it is read.
template <typename T>
const T* value_in(const Object& object, const std::string& name) {
  const Property* property = find_property(object, name);
  return property ? std::get_if<T>(&property->value) : nullptr;
}

/// The row that places objects of a type in the world; null if there is none.
const Parameter* placing_row(const TypeInfo& info) {
  for (const Parameter& row : info.parameters)
    if (row.when_moved == WhenMoved::composed) return &row;
  return nullptr;
}

/// First `inner`, then `outer`.
Transform compose(const Transform& outer, const Transform& inner, const Place& place) {
  try {
    const Transform composed = outer * inner;
    if (composed.dimensions() < 3) return composed;
    double rows[4][4];
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) rows[i][j] = composed.at(i, j);
    return Transform(rows);
  } catch (const std::invalid_argument&) {
    throw Error(ErrorKind::input, "the transforms of a placed scene shrink or grow it to nothing",
                "use less extreme scales", place);
  }
}

/// The object brought to where `world` puts it, as its table says.
std::shared_ptr<Object> moved(const Object& object, const TypeInfo& info, const Transform& world) {
  auto copy = std::make_shared<Object>(object);
  const Parameter* placing = placing_row(info);
  Transform own;  // the identity where no transform is given
  if (placing)
    if (const auto* given = value_in<Transform>(object, placing->name)) own = *given;
  bool has_stand_in = false;
  for (const Parameter& row : info.parameters) {
    const auto* value = value_in<Vec3d>(object, row.name);
    if (!value || row.when_moved == WhenMoved::stays) continue;
    if (row.when_moved == WhenMoved::origin) {
      own = Transform::translate(*value);
      std::erase_if(copy->properties, [&](const Property& p) { return p.name == row.name; });
    } else if (row.when_moved == WhenMoved::turned) {
      set_property(*copy, row.name, Vec3d(world.vector(Vec3f(*value))));
      has_stand_in = has_stand_in || (placing && row.stands_for == placing->name);
    }
  }
  if (placing && !has_stand_in)
    set_property(*copy, placing->name, compose(world, own, object.place));
  return copy;
}

/// An emitter of a group brought to where `world` puts it.
std::shared_ptr<Object> placed_emitter(const Object& emitter, const Transform& world) {
  const auto& types = light_types();
  const auto type = std::find_if(types.begin(), types.end(), [&](const LightType& row) {
    return row.info.name == emitter.type;
  });
  // What is wrong with it will be told when it is made.
  if (type == types.end() || type->needs_shape) return std::make_shared<Object>(emitter);
  if (!placing_row(type->info))
    throw Error(ErrorKind::input,
                fmt::format("emitter '{}' lights the whole world: it cannot stand in a shape "
                            "group",
                            emitter.type),
                "put it at the top of the scene", emitter.place);
  return moved(emitter, type->info, world);
}

/// A shape, of whatever type, brought to where `world` puts it, without the sensors in it.
std::shared_ptr<Object> placed_shape(const Object& shape, const Transform& world) {
  const TypeInfo* info = scene_types().find(shape.family, shape.type);
  auto placed = info ? moved(shape, *info, world) : std::make_shared<Object>(shape);
  std::erase_if(placed->children,
                [](const Child& child) { return child.object->family == "sensor"; });
  return placed;
}

class Flattener {
 public:
  explicit Flattener(std::vector<std::string>& warnings) : warnings_(warnings) {}

  Description flatten(const Object& scene) {
    Description flat{std::make_shared<Object>(scene)};
    top_ = flat.scene.get();
    top_->children.clear();
    for (const Child& child : scene.children) {
      const Object* group = group_of(*child.object);
      if (group && !is_flat(*group)) {
        count(*child.object);
        place(*child.object, Transform(), 0);
      } else {
        top_->children.push_back(child);
      }
    }
    return flat;
  }

 private:
  /// The group that an instance places; null for everything else.
  static const Object* group_of(const Object& object) {
    if (!is_shape(object, "instance") || object.children.size() != 1) return nullptr;
    const Object* group = object.children[0].object.get();
    return is_shape(*group, "shapegroup") ? group : nullptr;
  }
  static bool is_flat(const Object& group) {
    return std::all_of(group.children.begin(), group.children.end(),
                       [](const Child& child) { return stays_in_group(*child.object); });
  }

  static void check_level(const Object& instance, int level) {
    if (level >= maximum_levels)
      throw Error(ErrorKind::input,
                  fmt::format("instances nest more than {} levels deep", maximum_levels),
                  "make the scene flatter", instance.place);
  }
  /// What placing a group once makes.
  struct Copies {
    size_t placements = 0, lamps = 0;
  };
  /// Refuses an instance of the top level that makes too much of the scene, before it is made.
  void count(const Object& instance) {
    const Copies copies = copies_in(instance, 0);
    placements_ += 1 + copies.placements;
    lamps_ += copies.lamps;
    if (placements_ > maximum_placements)
      throw Error(
          ErrorKind::input,
          fmt::format("instances of instances make more than {} placements", maximum_placements),
          "use fewer, or put shapes into one group", instance.place);
    if (lamps_ > maximum_lamps)
      throw Error(
          ErrorKind::input,
          fmt::format("instances make more than {} lamps of those in groups", maximum_lamps),
          "use fewer, or let one shape shine for several", instance.place);
  }
  /// What one placing of `instance`'s group brings with it, or more than the most.
  Copies copies_in(const Object& instance, int level) {
    check_level(instance, level);
    const Object& group = *group_of(instance);
    const auto known = copies_in_.find(&group);
    if (known != copies_in_.end()) return known->second;
    Copies copies;
    for (const Child& child : group.children) {
      if (child.object->family == "emitter" || shines(*child.object)) ++copies.lamps;
      if (!group_of(*child.object)) continue;
      const Copies more = copies_in(*child.object, level + 1);
      copies.placements = std::min(copies.placements + 1 + more.placements, maximum_placements + 1);
      copies.lamps = std::min(copies.lamps + more.lamps, maximum_lamps + 1);
    }
    return copies_in_[&group] = copies;
  }

  void place(const Object& instance, const Transform& outer, int level) {
    check_level(instance, level);
    const auto* own = value_in<Transform>(instance, placing_row(instance_info())->name);
    const Transform world = compose(outer, own ? *own : Transform(), instance.place);
    const Object& group = *group_of(instance);
    if (const auto dark = dark_part(instance.children[0].object)) {
      auto placed = std::make_shared<Object>(instance);
      set_property(*placed, placing_row(instance_info())->name, world);
      placed->children[0].object = dark;
      top_->children.push_back({"", placed});
    }
    for (const Child& child : group.children) place_part(*child.object, world, level);
  }

  void place_part(const Object& part, const Transform& world, int level) {
    if (group_of(part))
      place(part, world, level + 1);
    else if (part.family == "emitter")
      top_->children.push_back({"", placed_emitter(part, world)});
    else if (shines(part))
      place_lamp(part, world);
    else if (is_shape(part, "instance"))
      top_->children.push_back({"", std::make_shared<Object>(part)});  // the builder refuses it
    else if (is_of_whole_picture(part))
      tell_of_no_effect(part);
  }

  void place_lamp(const Object& lamp, const Transform& world) {
    for (const Child& child : lamp.children)
      if (child.object->family == "sensor") tell_of_no_effect(*child.object);
    top_->children.push_back({"", placed_shape(lamp, world)});
  }

  void tell_of_no_effect(const Object& part) {
    if (reported_.insert(&part).second)
      warnings_.push_back(fmt::format("the {} of a placed scene has no effect", part.family));
  }

  /// The group's shapes that stay in it, one object for all placements; null if there are none.
  std::shared_ptr<Object> dark_part(const std::shared_ptr<Object>& group) {
    const auto [entry, is_new] = dark_parts_.try_emplace(group.get());
    if (!is_new) return entry->second;
    auto dark = std::make_shared<Object>(*group);
    std::erase_if(dark->children, [](const Child& c) { return !stays_in_group(*c.object); });
    if (!dark->children.empty() || group->children.empty()) entry->second = dark;
    return entry->second;
  }

  std::vector<std::string>& warnings_;
  Object* top_ = nullptr;
  size_t placements_ = 0, lamps_ = 0;
  std::map<const Object*, Copies> copies_in_;
  std::map<const Object*, std::shared_ptr<Object>> dark_parts_;
  std::set<const Object*> reported_;
};

}  // namespace

Description flatten_placed_scenes(const Description& description,
                                  std::vector<std::string>& warnings) {
  return Flattener(warnings).flatten(*without_merges(description.scene));
}

}  // namespace kaustik
