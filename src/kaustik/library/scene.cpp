#include "kaustik/scene.h"

#include <algorithm>

#include "kaustik/base/parallel.h"
#include "kaustik/library/access.h"
#include "kaustik/library/boundary.h"
#include "kaustik/loader/scene_format.h"
#include "kaustik/render/prepared_scene.h"
#include "kaustik/scene/overrides.h"

namespace kaustik::v0 {
namespace {

using details::Access;
using details::ObjectState;
using details::SceneState;

/// What messages call a scene that came as text.
constexpr const char* text_place = "scene text";

/// Takes what has the name, or stands for the parameter of that name, out of an object.
void forget(kaustik::Object& object, const std::string& name) {
  std::erase_if(object.properties, [&](const Property& p) { return p.name == name; });
  std::erase_if(object.children, [&](const Child& c) { return c.name == name; });
}

kaustik::LoadOptions internal(const LoadOptions& options) {
  return {.definitions = options.definitions,
          .is_strict = options.is_strict,
          .definitions_origin = "LoadOptions::definitions"};
}

}  // namespace

Object::Object(std::string family, std::string type, std::string id)
    : state_(std::make_shared<ObjectState>(ObjectState{{.family = std::move(family),
                                                        .type = std::move(type),
                                                        .id = std::move(id),
                                                        .properties = {},
                                                        .children = {},
                                                        .place = place_in(program_place)}})) {}

ObjectState& Object::own() {
  if (state_.use_count() > 1) state_ = std::make_shared<ObjectState>(*state_);
  return *state_;
}

Object& Object::set(std::string name, Value value) {
  ObjectState& object = own();
  forget(object, name);
  object.properties.push_back({std::move(name), Access::value(value), place_in(program_place)});
  return *this;
}

Object& Object::add(const Object& object, std::string name) {
  // Kept first: it may be this one.
  const std::shared_ptr<ObjectState> child = object.state_;
  ObjectState& parent = own();
  if (!name.empty()) forget(parent, name);
  parent.children.push_back({std::move(name), child});
  return *this;
}

Scene::Scene(std::shared_ptr<const SceneState> state) : state_(std::move(state)) {}

Scene::Scene(const std::vector<Object>& objects) {
  auto scene = std::make_shared<kaustik::Object>();
  scene->family = "scene";
  scene->place = place_in(program_place);
  for (const Object& object : objects) scene->children.push_back({"", Access::object(object)});
  state_ = std::make_shared<const SceneState>(SceneState{.description = {std::move(scene)}});
}

Scene Scene::load_file(const std::string& path, const LoadOptions& options) {
  return guarded([&] {
    return Scene(std::make_shared<const SceneState>(
        SceneState{.description = load_scene(path, internal(options)),
                   .file = path,
                   .load = internal(options)}));
  });
}

Scene Scene::load_string(std::string_view text, const LoadOptions& options,
                         const std::string& folder) {
  return guarded([&] {
    return Scene(std::make_shared<const SceneState>(SceneState{
        .description = parse_scene(std::string(text), text_place, folder, internal(options))}));
  });
}

Scene Scene::edit(const std::vector<Edit>& edits) const {
  return guarded([&] {
    SceneState edited{.description = copy_of(state_->description),
                      .built = std::make_shared<details::BuiltScene>(state_->built)};
    for (const auto& [key, value] : edits) {
      const size_t dot = key.rfind('.');
      if (dot == std::string::npos || dot == 0 || dot + 1 == key.size())
        throw wrong_input("cannot read the key '" + key + "'",
                          "write object.parameter, such as integrator.max_depth");
      override_property(edited.description, key.substr(0, dot),
                        {key.substr(dot + 1), Access::value(value), place_in(program_place)});
    }
    return Scene(std::make_shared<const SceneState>(std::move(edited)));
  });
}

std::vector<std::string> Scene::check(int threads) const {
  return guarded([&] {
    std::vector<std::string> warnings;
    Messages messages;
    messages.warning = [&](const std::string& text) { warnings.push_back(text); };
    Description description = copy_of(state_->description);
    with_threads(std::max(0, threads), [&] {
      apply_changes(description, {}, messages);
      state_->built->put(
          prepare_scene(description, {}, false, messages, state_->built->get()).scene);
    });
    return warnings;
  });
}

}  // namespace kaustik::v0
