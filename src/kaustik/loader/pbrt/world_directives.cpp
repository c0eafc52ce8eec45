// The part of Directives that puts something into the world, or reads another file.

#include <fmt/format.h>

#include "kaustik/loader/pbrt/directives.h"

namespace kaustik::pbrt {

void Directives::shape(const Call& call) {
  Setting given = setting(call);
  world_.add_shape(given.type, std::move(given.parameters), state_);
}

void Directives::light_source(const Call& call) {
  Setting given = setting(call);
  world_.add_light(given.type, std::move(given.parameters), state_);
}

void Directives::area_light_source(const Call& call) {
  Setting given = setting(call);
  state_.area_light = world_.area_light(given.type, std::move(given.parameters), state_);
}

void Directives::material(const Call& call) {
  Setting given = setting(call);
  state_.material = {
      world_.define_material("", given.type, std::move(given.parameters), state_), {}, 0, {}};
}

void Directives::make_named_material(const Call& call) {
  const std::string name = quoted(call, "a name");
  ParameterList list = parameters(call);
  const std::string type = list.text("type");
  world_.define_material(name, type, std::move(list), state_);
}

void Directives::named_material(const Call& call) {
  const std::string name = quoted(call, "a name");
  ParameterList none = parameters(call);
  state_.material = world_.material_named(name, call.place());
}

void Directives::texture(const Call& call) {
  const std::string name = quoted(call, "a name");
  const std::string kind = quoted(call, "a type");
  const std::string type = quoted(call, "a class");
  ParameterList list = parameters(call);
  if (kind != "float" && kind != "spectrum" && kind != "color")
    throw Error(ErrorKind::input, fmt::format("textures of type {} are not known", shown(kind)),
                "write float or spectrum", call.place());
  world_.define_texture(name, kind == "float", type, std::move(list), state_);
}

void Directives::make_named_medium(const Call& call) {
  const std::string name = quoted(call, "a name");
  ParameterList list = parameters(call);
  const std::string type = list.text("type");
  world_.define_medium(name, type, std::move(list), state_);
}

void Directives::medium_interface(const Call& call) {
  MediumSides sides;
  sides.inside = sides.outside = quoted(call, "a name");
  if (call.tokens.peek().kind == TokenKind::quoted) sides.outside = quoted(call, "a name");
  sides.is_given = true;
  sides.place = call.place();
  state_.media = std::move(sides);
}

void Directives::object_begin(const Call& call) {
  const std::string name = quoted(call, "a name");
  world_.begin_object(name, call.place());
  push(call, false);
}

void Directives::object_end(const Call& call) {
  world_.end_object(call.place());
  pop(call, false);
}

void Directives::object_instance(const Call& call) {
  const std::string name = quoted(call, "a name");
  world_.add_instance(name, call.place(), state_);
}

void Directives::include(const Call& call) {
  const std::string name = quoted(call, "a name");
  const SceneFiles::Opened file(files_, name, call.place());
  run(file.source());
}

void Directives::import(const Call& call) {
  const std::string name = quoted(call, "a name");
  const SceneFiles::Opened file(files_, name, call.place());
  const GraphicsState before = state_;
  const size_t depth = saved_.size();
  run(file.source());
  if (saved_.size() != depth)
    throw Error(ErrorKind::input, fmt::format("{} does not end what it begins", shown(name)),
                "let every AttributeBegin have its AttributeEnd there", call.place());
  state_ = before;
}

}  // namespace kaustik::pbrt
