#pragma once
#include <optional>

#include "kaustik/base/vec.h"
#include "kaustik/scene/description.h"
#include "kaustik/view/json_text.h"

namespace kaustik {
class Scene;
}

namespace kaustik::view {

/// Where a camera stands and looks, in the world, m.
struct CameraPose {
  Vec3d origin{0, 0, 0}, target{0, 0, 1}, up{0, 1, 0};
  std::optional<double> fov;  ///< degrees, along the camera's fov_axis; none: it has none
};

/// Throws RequestError for what is no camera of a command.
CameraPose camera_pose_from(const Json& json);
Json json_of(const CameraPose& pose);

/// The camera of a description, which has one, and what of its to_world is no pose: scales and
/// mirrors, which stay as the scene has them while it is moved.
class MovableCamera {
 public:
  explicit MovableCamera(const Description& description);

  /// As the description has it; the target lies `distance` ahead, m. `built`, null: none, tells
  /// what the description does not.
  CameraPose pose(const Description& description, double distance, const Scene* built) const;
  /// Puts the description's camera there. Throws RequestError where that cannot be.
  void put(Description& description, const CameraPose& pose) const;

 private:
  Transform camera_from_shape_;
};

/// How far ahead of the camera lies what is seen in the middle of the picture, or the middle of the
/// scene where nothing is seen there, m; positive.
double distance_ahead(const Scene& scene);

}  // namespace kaustik::view
