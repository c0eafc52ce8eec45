// The part of SceneBuilder for bsdfs and textures.

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "kaustik/scene/find_row.h"
#include "kaustik/scene/scene_builder.h"
#include "kaustik/scene/shape_attribute.h"
#include "kaustik/scene/spectrum_types.h"
#include "kaustik/scene/texture_rows.h"
#include "kaustik/scene/types_to_come.h"

namespace kaustik {
namespace {

bool takes_volumes(const TypeInfo& info) {
  return std::any_of(info.parameters.begin(), info.parameters.end(),
                     [](const Parameter& row) { return row.accepts_volume; });
}

/// Of all that can be written as a texture.
std::vector<std::string> texture_names() {
  std::vector<std::string> names = names_of(texture_types());
  for (const SpectrumType& spectrum : spectrum_types()) names.push_back(spectrum.info.name);
  return names;
}

/// Whether a bsdf or another texture can not do without it.
bool is_needed(const Parameter& row) {
  return row.accepts_texture && std::holds_alternative<std::monostate>(row.default_value);
}

std::string takes_no_texture(const Object& object, const std::string& name) {
  return fmt::format("{} '{}' takes no texture {}", object.family, object.type,
                     name.empty() ? "without a name" : fmt::format("'{}'", name));
}

/// How many bsdfs one of the type may hold.
std::string remedy_for_nested(const BsdfType& type) {
  if (type.maximum_nested == 0) return "take them out: it holds none";
  if (type.minimum_nested == type.maximum_nested)
    return fmt::format("give it {}", type.minimum_nested);
  return fmt::format("give it {} {} {}", type.minimum_nested,
                     type.minimum_nested + 1 == type.maximum_nested ? "or" : "to",
                     type.maximum_nested);
}

/// See TextureOfParameter; valid as long as the two are.
TextureOfParameter textures_for(
    const Arguments& arguments,
    const std::map<std::string, std::shared_ptr<const Texture>, std::less<>>& nested) {
  return [&](std::string_view name) -> std::shared_ptr<const Texture> {
    const auto found = nested.find(name);
    return found != nested.end() ? found->second : constant_texture_of(arguments, name);
  };
}

}  // namespace

bool SceneBuilder::leaves_out_texture(const Object& object, const TypeInfo& info,
                                      const Child& child) {
  if (is_strict_) return false;
  const Parameter* row = info.find(child.name);
  if (row && row->no_effect) {
    ignore({child.name, {}, child.object->place},
           fmt::format("{} '{}'", object.family, object.type));
    return true;
  }
  if (row && mean_instead_of(info, child)) return true;
  if (!row && !nearest_name(child.name, texture_parameters(info)).empty()) return false;
  if (left_out_.insert(child.object.get()).second)
    unknown_.add(takes_no_texture(object, child.name) + ": it is left out", child.object->place);
  return true;
}

const Object* SceneBuilder::foreign_texture_in(const Object& texture) const {
  if (is_foreign(texture, texture_names())) return &texture;
  const TextureType* type = find_row(texture_types(), texture.type);
  return type ? foreign_texture_of(texture, type->info) : nullptr;
}

const Object* SceneBuilder::foreign_texture_of(const Object& holder, const TypeInfo& info) const {
  for (const Child& child : holder.children) {
    if (child.object->family != "texture" || spectrum_type_of(*child.object)) continue;
    const Parameter* row = texture_parameter(info, child.name);
    if (!row || !is_needed(*row)) continue;
    if (const Object* foreign = foreign_texture_in(*texture_within(child.object))) return foreign;
  }
  return nullptr;
}

bool SceneBuilder::asks_surface(const Object& object) {
  const auto known = asks_surface_.find(&object);
  if (known != asks_surface_.end()) return known->second;
  const TextureType* type =
      object.family == "texture" ? find_row(texture_types(), object.type) : nullptr;
  bool asks = type && type->asks_surface;
  for (const Child& child : object.children) asks = asks || asks_surface(*child.object);
  return asks_surface_[&object] = asks;
}

SceneBuilder::MadeOn SceneBuilder::made_on(const Object& object, const BuiltShape* on) {
  return {&object, on && asks_surface(object) ? on->shape.get() : nullptr};
}

std::shared_ptr<const SurfaceAttribute> SceneBuilder::attribute_of(const BuiltShape* on,
                                                                   const std::string& name,
                                                                   const Place& place) {
  if (!on || !on->shape) return nullptr;
  try {
    return std::make_shared<ShapeAttribute>(
        on->shape, attribute_named(*on->shape, on->surface.name, name, place));
  } catch (const Error& error) {
    if (is_strict_ || error.kind() != ErrorKind::input) throw;
    const Problem& problem = error.problems().front();
    warnings_.push_back(fmt::format("{}: {}: it is black there; {}", text_of(place),
                                    problem.message, problem.remedy));
    return std::make_shared<NoAttribute>();
  }
}

std::shared_ptr<const Texture> SceneBuilder::make_texture(const std::shared_ptr<Object>& object,
                                                          const BuiltShape* on) {
  const MadeOn key = made_on(*object, on);
  const auto known = textures_.find(key);
  if (known != textures_.end()) return known->second;
  return textures_[key] = create_texture(*object, on);
}

std::shared_ptr<const Texture> SceneBuilder::create_texture(const Object& object,
                                                            const BuiltShape* on) {
  const TextureType* type = find_row(texture_types(), object.type);
  if (!type) {
    unknown_type(object, texture_names());
    return nullptr;
  }
  if (const auto instead = stand_in_for_file(object, type->info))
    return create_texture(*instead, on);
  std::vector<std::string> families;
  if (!texture_parameters(type->info).empty()) families.emplace_back("texture");
  if (takes_volumes(type->info)) families.emplace_back("volume");
  refuse_children(object, families);
  std::optional<Textures> nested = Textures();
  if (!texture_parameters(type->info).empty()) nested = textures_of(object, type->info, on);
  std::optional<Volumes> volumes = Volumes();
  if (takes_volumes(type->info)) volumes = volumes_of(object, type->info);
  const Arguments arguments = arguments_of(type->info, object);
  if (!nested || !volumes || !arguments.is_complete()) return nullptr;
  std::shared_ptr<const Texture> texture;
  const auto attribute = [&](const std::string& name) {
    return attribute_of(on, name, arguments.place_of("name"));
  };
  const auto volume = [&](std::string_view name) -> std::shared_ptr<const Volume> {
    const auto found = volumes->find(name);
    return found != volumes->end() ? found->second.volume : nullptr;
  };
  collecting(source_place(arguments), [&] {
    texture =
        texture_of(object, *type,
                   {arguments, pictures_, textures_for(arguments, *nested), attribute, volume}, on);
  });
  if (texture && texture->size() > maximum_texture_size) {
    problems_.add(fmt::format("texture '{}' nests {} textures, each counted for every place it is "
                              "used in: rendering it would take too long",
                              object.type, texture->size() - 1),
                  fmt::format("nest fewer: at most {} in all", maximum_texture_size - 1),
                  object.place);
    return nullptr;
  }
  return texture;
}

std::optional<SceneBuilder::Textures> SceneBuilder::textures_of(const Object& object,
                                                                const TypeInfo& info,
                                                                const BuiltShape* on) {
  Textures textures;
  for (const Child& child : object.children) {
    if (child.object->family != "texture" || spectrum_type_of(*child.object)) continue;
    const Parameter* parameter = texture_parameter(info, child.name);
    const std::vector<std::string> valid = texture_parameters(info);
    if (!parameter && object.family == "emitter" && valid.size() == 1 && !is_strict_ &&
        !info.find(child.name) && nearest_name(child.name, valid).empty()) {
      parameter = info.find(valid.front());
      unknown_.add(fmt::format("the texture '{}' of emitter '{}' is taken as '{}'", child.name,
                               object.type, parameter->name),
                   child.object->place);
    }
    if (!parameter && leaves_out_texture(object, info, child)) continue;
    if (!parameter) {
      problems_.add(takes_no_texture(object, child.name),
                    valid.empty() ? "remove it" : suggest(child.name, valid), child.object->place);
      continue;
    }
    const std::shared_ptr<Object>& given = texture_within(child.object);
    if (const Object* foreign = foreign_texture_in(*given)) {
      leave_out(*foreign, "it is left out");
      continue;
    }
    auto& texture = textures[parameter->name];
    if (texture)
      problems_.add(
          fmt::format("{} '{}' has a second texture '{}'", object.family, object.type, child.name),
          "keep one", child.object->place);
    texture = make_texture(given, on);
    if (!texture) return std::nullopt;
  }
  return textures;
}

std::shared_ptr<const Bsdf> SceneBuilder::make_bsdf(const std::shared_ptr<Object>& object,
                                                    const BuiltShape* on) {
  const MadeOn key = made_on(*object, on);
  const auto known = bsdfs_.find(key);
  if (known != bsdfs_.end()) return known->second;
  return bsdfs_[key] = create_bsdf(*object, on);
}

std::shared_ptr<const Bsdf> SceneBuilder::create_bsdf(const Object& object, const BuiltShape* on) {
  const BsdfType* type = find_row(bsdf_types(), object.type);
  if (!type) {
    const bool is_to_come = remedy_for_type_to_come(object).has_value();
    if (is_to_come && is_strict_) {
      not_here_yet(object);
      return nullptr;
    }
    if (is_to_come || is_foreign(object, names_of(bsdf_types())))
      return bsdf_instead_of(object, on);
    unknown_type(object, names_of(bsdf_types()));
    return nullptr;
  }
  refuse_children(object, {"bsdf", "texture"});
  std::vector<std::shared_ptr<const Bsdf>> nested;
  for (const Child* child : ordered_children(object, "bsdf")) {
    nested.push_back(make_bsdf(child->object, on));
    if (!nested.back()) return nullptr;
  }
  if (const Object* foreign = foreign_texture_of(object, type->info);
      foreign && nested.size() == 1) {
    leave_out(*foreign, fmt::format("the bsdf in '{}' stands for it", object.type));
    return nested.front();
  }
  const std::optional<Textures> textures = textures_of(object, type->info, on);
  if (!textures) return nullptr;
  if (int(nested.size()) < type->minimum_nested || int(nested.size()) > type->maximum_nested) {
    problems_.add(fmt::format("bsdf '{}' holds {} bsdfs", object.type, nested.size()),
                  remedy_for_nested(*type), object.place);
    return nullptr;
  }
  const Arguments arguments = arguments_of(type->info, object);
  const auto warn = [&](const std::string& message) {
    if (remarks_reported_.insert(message).second) warnings_.push_back(message);
  };
  std::shared_ptr<const Bsdf> bsdf;
  collecting(object.place, [&] {
    bsdf = bsdf_of(object, *type,
                   {arguments, nested, textures_for(arguments, *textures), warn, is_strict_}, on);
  });
  if (bsdf && bsdf->traits().size > maximum_bsdf_size) {
    problems_.add(fmt::format("bsdf '{}' nests {} bsdfs, each counted for every place it is used "
                              "in: rendering it would take too long",
                              object.type, bsdf->traits().size - 1),
                  fmt::format("nest fewer, and blend the same one only once: at most {} in all",
                              maximum_bsdf_size - 1),
                  object.place);
    return nullptr;
  }
  return bsdf;
}

}  // namespace kaustik
