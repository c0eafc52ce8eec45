#include "kaustik/loader/mitsuba3_textures.h"

#include <algorithm>
#include <array>

#include "kaustik/loader/object_parts.h"

namespace kaustik {
namespace {

Rgb product(const Rgb& a, const Rgb& b) { return {a.r * b.r, a.g * b.g, a.b * b.b}; }

bool is_grey(const Rgb& c) { return c.r == c.g && c.g == c.b; }

bool is_scale(const Object& object) { return object.family == "texture" && object.type == "scale"; }

/// Of a texture `scale`; nothing where it is a curve.
std::optional<Rgb> factor_in(const Object& scale) {
  return find_property(scale, "scale") ? colour_in(scale, "scale") : Rgb{1, 1, 1};
}

const Child* nested_texture(const Object& object) {
  for (const Child& child : object.children)
    if (child.object->family == "texture") return &child;
  return nullptr;
}

Value colour_value(const Rgb& colour) { return is_grey(colour) ? Value(colour.r) : Value(colour); }

}  // namespace

Rgb TextureScaling::factor_of(const Object& bitmap) const {
  const auto known = factors_.find(&bitmap);
  return known != factors_.end() ? known->second : Rgb{1, 1, 1};
}

TextureScaling::Scaled TextureScaling::scaled(const std::shared_ptr<Object>& texture,
                                              const Rgb& factor) {
  if (is_scale(*texture)) {
    const auto own = factor_in(*texture);
    if (!own) return {};
    const Rgb all = product(*own, factor);
    if (const auto value = colour_in(*texture, "value")) return colour_value(product(*value, all));
    const Child* nested = nested_texture(*texture);
    return nested ? scaled(nested->object, all) : Scaled();
  }
  if (factor == Rgb{1, 1, 1}) return texture;
  if (texture->type == "bitmap") {
    if (!value_in<std::string>(*texture, "filename")) return {};
    std::shared_ptr<Object>& copy = bitmaps_[{texture.get(), {factor.r, factor.g, factor.b}}];
    if (!copy) {
      copy = std::make_shared<Object>(*texture);
      copy->id.clear();
      factors_[copy.get()] = product(factor_of(*texture), factor);
    }
    return copy;
  }
  if (texture->type == "checkerboard") return scaled_colours(*texture, factor);
  const bool has_number = texture->type == "mesh_attribute" || texture->type == "d65";
  if (!is_grey(factor) || !has_number || nested_texture(*texture)) return {};
  auto copy = std::make_shared<Object>(*texture);
  copy->id.clear();
  multiply_number(*copy, "scale", factor.r);
  return copy;
}

TextureScaling::Scaled TextureScaling::scaled_colours(const Object& texture, const Rgb& factor) {
  auto copy = std::make_shared<Object>(texture);
  copy->id.clear();
  for (const char* name : {"color0", "color1"}) {
    const auto nested = std::ranges::find(copy->children, name, &Child::name);
    if (nested != copy->children.end()) {
      const std::shared_ptr<Object> before = nested->object;
      if (!replace(*copy, name, scaled(before, factor))) return {};
      continue;
    }
    auto colour = colour_in(texture, name);
    if (!find_property(texture, name)) {
      const Parameter* row = types_.find("texture", texture.type)->find(name);
      if (const auto* usual = std::get_if<Value>(&row->default_value)) colour = as_colour(*usual);
    }
    if (!colour) return {};
    remove_property(*copy, name);
    copy->properties.push_back({name, colour_value(product(*colour, factor)), texture.place});
  }
  return copy;
}

/// Puts something in place of the texture `name` of an object; false: there is nothing.
bool TextureScaling::replace(Object& holder, const std::string& name, const Scaled& by) {
  const auto at = std::ranges::find_if(holder.children, [&](const Child& child) {
    return child.name == name && child.object->family == "texture";
  });
  if (const auto* texture = std::get_if<std::shared_ptr<Object>>(&by)) {
    at->object = *texture;
    return true;
  }
  const auto* value = std::get_if<Value>(&by);
  if (!value) return false;
  holder.properties.push_back({name, *value, at->object->place});
  holder.children.erase(at);
  return true;
}

/// A bump map has a factor of its own, a number.
bool TextureScaling::use_scale_of_bump(Object& bump) {
  for (Child& child : bump.children) {
    if (!is_scale(*child.object)) continue;
    const auto factor = factor_in(*child.object);
    const Child* nested = nested_texture(*child.object);
    if (!factor || !is_grey(*factor) || !nested) return false;
    multiply_number(bump, "scale", factor->r);
    child.object = std::shared_ptr<Object>(nested->object);
    return true;
  }
  return false;
}

void TextureScaling::apply_to(Object& holder) {
  if (is_scale(holder)) return;
  if (holder.family == "bsdf" && holder.type == "bumpmap")
    while (use_scale_of_bump(holder)) {
    }
  const TypeInfo* info = types_.find(holder.family, holder.type);
  std::vector<std::string> names;
  for (const Child& child : holder.children)
    if (is_scale(*child.object)) names.push_back(child.name);
  for (const std::string& name : names) {
    const auto at = std::ranges::find(holder.children, name, &Child::name);
    const std::shared_ptr<Object> texture = at->object;
    const Scaled by = scaled(texture, {1, 1, 1});
    // A value needs the name of a parameter, which a texture does not.
    if (std::holds_alternative<Value>(by) && !(info && info->find(name))) continue;
    replace(holder, name, by);
  }
}

void TextureScaling::use_scale_of_lamp(Object& lamp) {
  const Property* given = find_property(lamp, "scale");
  const auto* number = given ? std::get_if<double>(&given->value) : nullptr;
  if (!number) return;
  const Rgb factor{*number, *number, *number};
  const auto texture = std::ranges::find(lamp.children, "radiance", &Child::name);
  if (texture != lamp.children.end()) {
    const std::shared_ptr<Object> before = texture->object;
    if (before->family != "texture" || !replace(lamp, "radiance", scaled(before, factor))) return;
  } else {
    const bool is_given = find_property(lamp, "radiance") != nullptr;
    const auto radiance = is_given ? colour_in(lamp, "radiance") : Rgb{1, 1, 1};
    if (!radiance) return;
    remove_property(lamp, "radiance");
    lamp.properties.push_back({"radiance", colour_value(product(*radiance, factor)), lamp.place});
  }
  remove_property(lamp, "scale");
}

}  // namespace kaustik
