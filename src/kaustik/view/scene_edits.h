#pragma once
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "kaustik/scene/description.h"
#include "kaustik/view/camera_pose.h"
#include "kaustik/view/json_text.h"

namespace kaustik::view {

/// An object that parameters are set of, by the name that commands call it.
struct NamedObject {
  std::string name;  ///< its id, or its family if the scene has one of that
  std::shared_ptr<Object> object;
};

/// The objects below the scene that have a name, each once.
std::vector<NamedObject> named_objects(const Description& description);
/// Gives those without a name an id of their own, made of their type: "sphere", "sphere_2".
void name_all_objects(Description& description);

/// A scene as its viewers edit it. Every edit is made to the last description that was not refused.
class SceneEdits {
 public:
  /// One camera, named objects: of a description of its own, with a recipe's changes.
  explicit SceneEdits(Description description);

  const Description& current() const { return edits_.back().description; }
  /// As `current` has it.
  CameraPose camera(const Scene* built) const;
  /// How far ahead the camera's target lies until it is told by who moves it, m.
  void set_distance(double distance) { distance_ = distance; }

  // The description with a change. Throw RequestError, which names it, for what cannot be.
  Description with_camera(const CameraPose& pose) const;
  /// "object.parameter" → value. Files cannot be set: who asks may be far away.
  Description with_settings(const Json& settings) const;
  Description with_integrator(const std::string& type) const;

  /// As it was before all edits.
  Description original() const { return copy_of(original_); }
  /// Where the camera was told to be, in `current`; none: it is as the scene has it.
  const std::optional<CameraPose>& told_pose() const { return edits_.back().pose; }

  /// The description was given to be rendered, with the camera where it was told to be.
  void taken(uint64_t revision, Description description, const std::optional<CameraPose>& pose);
  /// What is known of the revisions: which is rendered, and which was refused last (0: none).
  void note(uint64_t rendered, uint64_t refused);

 private:
  struct Edit {
    uint64_t revision;
    Description description;
    std::optional<CameraPose> pose;  ///< as it was told, if it was
  };
  MovableCamera movable_;
  Description original_;
  double distance_ = 1;
  std::deque<Edit> edits_;  ///< never empty: the first is rendered, or was not refused yet
};

}  // namespace kaustik::view
