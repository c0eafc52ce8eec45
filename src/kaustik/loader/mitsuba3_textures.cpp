#include "kaustik/loader/mitsuba3_textures.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>

#include "kaustik/base/error.h"
#include "kaustik/loader/object_parts.h"

namespace kaustik {
namespace {

/// In one another, each counted for every place it is used in: with more no scene is built.
constexpr size_t most_textures = 256;

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

/// Whether the parameter may have that value: what is beyond a range is an error, or is scaled.
bool takes(const Parameter& row, const Rgb& colour) {
  const auto is_in_range = [&](double lane) {
    return std::isfinite(lane) && lane >= row.minimum && lane <= row.maximum;
  };
  return (row.kind == ParameterKind::color || is_grey(colour)) && is_in_range(colour.r) &&
         is_in_range(colour.g) && is_in_range(colour.b);
}

/// Whether it is one value over the whole surface, from a table of spectra.
bool is_spectrum(const Object& texture) {
  static const std::set<std::string_view> types = {"blackbody", "d65",     "irregular",  "regular",
                                                   "srgb",      "uniform", "rawconstant"};
  return types.contains(texture.type) && !nested_texture(texture);
}

}  // namespace

Rgb TextureScaling::factor_of(const Object& bitmap) const {
  const auto known = factors_.find(&bitmap);
  return known != factors_.end() ? known->second : Rgb{1, 1, 1};
}

size_t TextureScaling::size_of(const Object& texture) {
  const auto [known, is_new] = sizes_.try_emplace(&texture, 1);
  if (!is_new) return known->second;
  size_t size = 1;
  for (const Child& child : texture.children)
    if (child.object->family == "texture")
      size = std::min(most_textures + 1, size + size_of(*child.object));
  return sizes_[&texture] = size;
}

TextureScaling::Scaled TextureScaling::scaled(const std::shared_ptr<Object>& texture,
                                              const Rgb& factor) {
  // The copies of what nests one texture in many places would be too many.
  if (size_of(*texture) > most_textures) return {};
  const TypeInfo* scale = types_.find("texture", "scale");
  if (!scale || !takes(*scale->find("scale"), factor)) return {};
  const auto key = std::pair(texture, std::array<double, 3>{factor.r, factor.g, factor.b});
  if (const auto known = scaled_.find(key); known != scaled_.end()) return known->second;
  return scaled_[key] = scaled_anew(texture, factor);
}

TextureScaling::Scaled TextureScaling::scaled_anew(const std::shared_ptr<Object>& texture,
                                                   const Rgb& factor) {
  if (is_scale(*texture)) {
    const auto own = factor_in(*texture);
    if (!own) return {};
    const Rgb all = product(*own, factor);
    if (const auto value = colour_in(*texture, "value")) return product(*value, all);
    const Child* nested = nested_texture(*texture);
    return nested ? scaled(nested->object, all) : Scaled();
  }
  if (factor == Rgb{1, 1, 1}) return texture;
  if (texture->type == "checkerboard") return scaled_colours(*texture, factor);
  const bool is_picture = texture->type == "bitmap" && value_in<std::string>(*texture, "filename");
  const bool has_number = (texture->type == "mesh_attribute" || texture->type == "d65") &&
                          is_grey(factor) && !nested_texture(*texture);
  if (!is_picture && !has_number) return {};
  auto copy = std::make_shared<Object>(*texture);
  copy->id.clear();
  if (is_picture)
    factors_[copy.get()] = product(factor_of(*texture), factor);
  else
    multiply_number(*copy, "scale", factor.r);
  return copy;
}

TextureScaling::Scaled TextureScaling::scaled_colours(const Object& texture, const Rgb& factor) {
  auto copy = std::make_shared<Object>(texture);
  copy->id.clear();
  const TypeInfo* info = types_.find("texture", texture.type);
  for (const char* name : {"color0", "color1"}) {
    const Parameter* row = info ? info->find(name) : nullptr;
    if (!row) return {};
    const auto nested = std::ranges::find(copy->children, name, &Child::name);
    if (nested != copy->children.end()) {
      if (!replace(*copy, *nested, row, scaled(nested->object, factor))) return {};
      continue;
    }
    auto colour = colour_in(texture, name);
    const auto* usual = std::get_if<Value>(&row->default_value);
    if (!find_property(texture, name) && usual) colour = as_colour(*usual);
    if (!colour || !takes(*row, product(*colour, factor))) return {};
    remove_property(*copy, name);
    copy->properties.push_back({name, colour_value(product(*colour, factor)), texture.place});
  }
  return copy;
}

/// Puts something in place of a texture in an object, where it stands for the parameter `row`
/// (null: for none); false: there is nothing, or the parameter does not take it.
bool TextureScaling::replace(Object& holder, Child& texture, const Parameter* row,
                             const Scaled& by) {
  if (const auto* other = std::get_if<std::shared_ptr<Object>>(&by)) {
    texture.object = *other;
    return true;
  }
  const auto* colour = std::get_if<Rgb>(&by);
  // A value needs the name of a parameter, which a texture does not.
  if (!colour || !row || !takes(*row, *colour)) return false;
  holder.properties.push_back({texture.name, colour_value(*colour), texture.object->place});
  holder.children.erase(holder.children.begin() + (&texture - holder.children.data()));
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
  // From the last one on, for what becomes a value is a child no more.
  for (size_t i = holder.children.size(); i-- > 0;) {
    Child& child = holder.children[i];
    if (!is_scale(*child.object)) continue;
    const std::shared_ptr<Object> texture = child.object;
    replace(holder, child, info ? info->find(child.name) : nullptr, scaled(texture, {1, 1, 1}));
  }
}

void TextureScaling::name_radiance(Object& lamp, const TypeInfo& info) {
  if (find_property(lamp, "radiance")) return;
  const auto is_texture = [](const Child& child) { return child.object->family == "texture"; };
  if (std::ranges::count_if(lamp.children, is_texture) != 1) return;
  Child& texture = *std::ranges::find_if(lamp.children, is_texture);
  if (!is_spectrum(*texture.object) && !info.find(texture.name) &&
      nearest_name(texture.name, {"radiance"}).empty())
    texture.name = "radiance";
}

void TextureScaling::use_radiance_of_lamp(Object& lamp) {
  const TypeInfo* info = types_.find(lamp.family, lamp.type);
  const Parameter* row = info ? info->find("radiance") : nullptr;
  if (!row) return;
  name_radiance(lamp, *info);
  const auto scale = number_in(lamp, "scale");
  if (!scale) return;
  const Rgb factor{*scale, *scale, *scale};
  const auto texture = std::ranges::find(lamp.children, "radiance", &Child::name);
  if (texture != lamp.children.end()) {
    const std::shared_ptr<Object> before = texture->object;
    if (before->family != "texture" || !replace(lamp, *texture, row, scaled(before, factor)))
      return;
  } else {
    const bool is_given = find_property(lamp, "radiance") != nullptr;
    const auto radiance = is_given ? colour_in(lamp, "radiance") : Rgb{1, 1, 1};
    if (!radiance || !takes(*row, product(*radiance, factor))) return;
    remove_property(lamp, "radiance");
    lamp.properties.push_back({"radiance", colour_value(product(*radiance, factor)), lamp.place});
  }
  remove_property(lamp, "scale");
}

}  // namespace kaustik
