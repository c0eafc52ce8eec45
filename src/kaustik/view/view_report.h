#pragma once
#include <string>
#include <vector>

#include "kaustik/live/watched.h"
#include "kaustik/view/camera_pose.h"
#include "kaustik/view/json_text.h"

namespace kaustik::view {

/// What a page is told of the view besides what the engine knows.
struct PageFacts {
  std::string scene;       ///< its name
  std::string integrator;  ///< that is asked for
  std::vector<std::string> layers;
  CameraPose camera;
  bool can_edit = true;  ///< the scene; false: a program renders it
};

/// As GET state gives it.
Json state_report(const Watched& shown, const EngineStatus& status, const PageFacts& facts);

/// The layers that pictures of a film have: "" is the picture itself.
std::vector<std::string> layer_names(const FilmLayers& layers);

/// How the error of the picture fell, thinned out to a few hundred points.
class ErrorHistory {
 public:
  /// Takes note where there is something new; false: there is not.
  bool note(const EngineStatus& status, bool is_moving);
  Json json() const;

 private:
  uint64_t revision_ = 0;
  uint32_t passes_ = 0, stride_ = 1, seen_ = 0;
  std::vector<double> elapsed_s_, errors_;
};

}  // namespace kaustik::view
