#pragma once
// Camera, film, filter, sampler and integrator of pbrt.

#include <memory>
#include <optional>
#include <string>

#include "kaustik/base/transform.h"
#include "kaustik/loader/pbrt/described.h"
#include "kaustik/loader/pbrt/parameters.h"
#include "kaustik/loader/pbrt/scene_files.h"

namespace kaustik::pbrt {

/// A directive before WorldBegin, such as Film.
struct Setting {
  std::string type;
  ParameterList parameters;
};

/// Whether a film of that type is of pbrt-v3 or older.
inline bool is_old_film(const std::string& type) { return type == "image"; }

/// What a file says before its world; what it does not name is as in pbrt.
struct ViewSettings {
  std::optional<Setting> camera, film, filter, sampler, integrator;
  Transform camera_from_world;  ///< the transform in force at Camera
  Place place;                  ///< of the file
};

/// What makers of the view work with.
struct ViewTools {
  SceneFiles& files;
  Deviations& deviations;
};

/// A sensor with its film and sampler.
std::shared_ptr<Object> make_sensor(const ViewTools& tools, const ViewSettings& settings);
/// The integrator: Kaustik's own choice with the longest path of the file's; null: any.
std::shared_ptr<Object> make_integrator(const ViewTools& tools, const ViewSettings& settings);

std::shared_ptr<Object> make_film(const ViewTools& tools, const ViewSettings& settings);

/// Width over height of the picture.
struct PictureSize {
  int width = 1280, height = 720;
  double aspect() const { return double(width) / height; }
};
PictureSize picture_size(const ViewSettings& settings);

/// A lens of several surfaces as a thin one.
struct ThinLens {
  double focal_length = 0.05;  ///< m
  double aperture = 0.01;      ///< diameter, m
};
/// Of rays near the axis, through a table of surfaces as pbrt has it: radius of curvature,
/// thickness, index, aperture, in millimetres, from the front to the film. Nothing: it is none.
std::optional<ThinLens> thin_lens_of(const std::vector<double>& table);

}  // namespace kaustik::pbrt
