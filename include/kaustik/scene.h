#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kaustik/value.h"

namespace kaustik::v0 {

namespace details {
struct ObjectState;
struct SceneState;
}  // namespace details

/// An object of a scene: family, type and parameters with the names of docs/reference, and
/// objects within it. A value: what is done to a copy leaves the other as it was. An object that is
/// put into several others unchanged is one in the scene.
class KAUSTIK_EXPORT Object {
 public:
  /// Such as ("bsdf", "diffuse"). The id is what edits and messages call it.
  Object(std::string family, std::string type, std::string id = {});
  Object(const Object&) = default;  // and nothing is moved: what one is taken from stays whole
  Object& operator=(const Object&) = default;

  /// Gives a parameter a value, in the place of one before.
  Object& set(std::string name, Value value);
  /// Puts an object into this one, under the name of the parameter that it stands for ("": none).
  Object& add(const Object& object, std::string name = {});

 private:
  friend struct details::Access;
  /// That nobody else has.
  details::ObjectState& own();
  std::shared_ptr<details::ObjectState> state_;
};

/// How scene files are read.
struct LoadOptions {
  /// Name and value of what `$name` stands for in the file.
  std::vector<std::pair<std::string, std::string>> definitions = {};
  /// What nobody knows is an error; otherwise it is left out and told.
  bool is_strict = false;
};

/// A change of a scene: "id.parameter", or "family.parameter" of a family that the scene has once,
/// such as "integrator.max_depth", and the value.
using Edit = std::pair<std::string, Value>;

/// A scene as it is described. Immutable; copies share all. What sessions build of it is kept with
/// it and its copies, so that the next session begins sooner.
class KAUSTIK_EXPORT Scene {
 public:
  /// Throws Error for what cannot be read.
  static Scene load_file(const std::string& path, const LoadOptions& options = {});
  /// The same of text. `folder` ("": the working folder) is what file names in it are relative to.
  static Scene load_string(std::string_view text, const LoadOptions& options = {},
                           const std::string& folder = {});
  /// Of objects at its top: sensor, emitters, shapes, integrator.
  explicit Scene(const std::vector<Object>& objects);
  Scene(const Scene&) = default;  // and nothing is moved
  Scene& operator=(const Scene&) = default;

  /// The scene with these changes. It shares objects' buffers with this one, and sessions build
  /// anew only what is different. Throws Error for an object that is not there; whether the
  /// parameter takes the value is told by check() and sessions.
  Scene edit(const std::vector<Edit>& edits) const;
  Scene edit(const std::string& key, const Value& value) const { return edit({{key, value}}); }

  /// Builds the scene, and throws an Error with everything that is wrong with it. Returns what is
  /// odd about it.
  std::vector<std::string> check(int threads = 0) const;

 private:
  friend struct details::Access;
  explicit Scene(std::shared_ptr<const details::SceneState> state);
  std::shared_ptr<const details::SceneState> state_;
};

}  // namespace kaustik::v0
