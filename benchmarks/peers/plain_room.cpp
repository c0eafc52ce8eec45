#include "benchmarks/peers/plain_room.h"

#include <fmt/format.h>

#include <map>

#include "kaustik/base/error.h"
#include "kaustik/loader/object_parts.h"

namespace kaustik::bench {
namespace {

/// Of rough metal made matt: about that of brass and steel.
constexpr Rgb metal_reflectance{0.6, 0.6, 0.6};
/// Of bitmaps, whose files are not looked into.
constexpr Rgb picture_reflectance{0.3, 0.3, 0.3};

[[noreturn]] void refuse(const Object& object, const std::string& what) {
  throw Error(ErrorKind::input,
              fmt::format("plain rooms know no {} (type '{}')", what, object.type), "",
              object.place);
}

/// The mean of a texture's two colours.
Rgb mean_colour(const Object& texture) {
  if (texture.type == "bitmap") return picture_reflectance;
  const auto a = colour_in(texture, "color0"), b = colour_in(texture, "color1");
  if (!a || !b) refuse(texture, "texture without two colours");
  return {(a->r + b->r) / 2, (a->g + b->g) / 2, (a->b + b->b) / 2};
}

/// What a bsdf has of that name, a colour or a texture; `otherwise` if it has none.
Rgb colour_of(const Object& bsdf, const std::string& name, const Rgb& otherwise) {
  for (const Child& child : bsdf.children)
    if (child.name == name) return mean_colour(*child.object);
  return colour_in(bsdf, name).value_or(otherwise);
}

/// Alike on both sides, as other renderers have it.
std::shared_ptr<Object> matt(const Object& bsdf, const Rgb& reflectance) {
  auto side = std::make_shared<Object>();
  side->family = "bsdf";
  side->type = "diffuse";
  side->place = bsdf.place;
  side->properties.push_back({"reflectance", reflectance, bsdf.place});
  auto both = std::make_shared<Object>();
  both->family = "bsdf";
  both->type = "twosided";
  both->id = bsdf.id;
  both->place = bsdf.place;
  both->children.push_back({"", side});
  return both;
}

std::shared_ptr<Object> plain_bsdf(const Object& bsdf) {
  constexpr Rgb half{0.5, 0.5, 0.5};
  if (bsdf.type == "twosided" && bsdf.children.size() == 1) {
    auto inside = plain_bsdf(*bsdf.children[0].object);
    inside->id = bsdf.id;
    return inside;
  }
  if (bsdf.type == "dielectric") return std::make_shared<Object>(bsdf);
  if (bsdf.type == "diffuse") return matt(bsdf, colour_of(bsdf, "reflectance", half));
  if (bsdf.type == "phong" || bsdf.type == "thinphong")
    return matt(bsdf, colour_of(bsdf, "diffuse_reflectance", half));
  if (bsdf.type == "roughconductor") return matt(bsdf, metal_reflectance);
  refuse(bsdf, "such bsdf");
}

class PlainRoom {
 public:
  explicit PlainRoom(const Object& scene) : room_{std::make_shared<Object>(scene)} {
    room_.scene->children.clear();
    for (const Child& child : scene.children) add(child);
  }
  Description take() { return std::move(room_); }

 private:
  void add(const Child& child) {
    const Object& object = *child.object;
    if (object.family == "emitter" || object.type == "shapegroup") return;
    if (object.type == "instance") {
      for (const Child& part : group_of(object).children)
        if (part.object->family == "shape") keep("", placed(*part.object, object));
    } else if (object.family == "shape") {
      keep(child.name, with_plain_bsdf(object));
    } else if (object.family == "bsdf") {
      keep(child.name, plain(child.object));
    } else {
      keep(child.name, child.object);
    }
  }
  void keep(const std::string& name, std::shared_ptr<Object> object) {
    room_.scene->children.push_back({name, std::move(object)});
  }

  static const Object& group_of(const Object& instance) {
    if (instance.children.size() != 1) refuse(instance, "instance of several or none");
    return *instance.children[0].object;
  }
  std::shared_ptr<Object> placed(const Object& shape, const Object& instance) {
    if (shape.type != "ply" && shape.type != "obj") refuse(shape, "such shape in a group");
    auto made = with_plain_bsdf(shape);
    const auto* outer = value_in<Transform>(instance, "to_world");
    const auto* inner = value_in<Transform>(shape, "to_world");
    remove_property(*made, "to_world");
    made->properties.push_back({"to_world",
                                (outer ? *outer : Transform()) * (inner ? *inner : Transform()),
                                instance.place});
    made->id.clear();
    return made;
  }
  std::shared_ptr<Object> with_plain_bsdf(const Object& shape) {
    auto made = std::make_shared<Object>(shape);
    for (Child& child : made->children)
      if (child.object->family == "bsdf") child.object = plain(child.object);
    return made;
  }
  /// Shared where the bsdf was.
  std::shared_ptr<Object> plain(const std::shared_ptr<Object>& bsdf) {
    std::shared_ptr<Object>& made = made_[bsdf.get()];
    if (!made) made = plain_bsdf(*bsdf);
    return made;
  }

  Description room_;
  std::map<const Object*, std::shared_ptr<Object>> made_;
};

}  // namespace

Description plain_room(const Description& description) {
  return PlainRoom(*description.scene).take();
}

}  // namespace kaustik::bench
