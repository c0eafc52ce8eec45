#pragma once
// How far pictures are from stored references (made by benchmarks/make_references.sh).
#include <filesystem>
#include <optional>

#include "benchmarks/report.h"
#include "benchmarks/shipped_scenes.h"
#include "kaustik/image/image_io.h"
#include "kaustik/image/metrics.h"
#include "kaustik/integrator/override_integrator.h"
#include "kaustik/render/session.h"
#include "kaustik/scene/overrides.h"

namespace kaustik::bench {

/// All pictures are rendered on so many threads.
inline constexpr int picture_threads = 2;

/// The stored reference of a scene that ships; if there is none, says how to make it.
inline std::optional<Image> reference_of(const std::string& name) {
  const std::string path =
      std::string(KAUSTIK_SOURCE_DIR) + "/benchmarks/references/" + name + ".exr";
  if (std::filesystem::exists(path)) return read_image(path);
  fmt::print(stderr, "there is no {}; make it: benchmarks/make_references.sh\n", path);
  return std::nullopt;
}

/// What every benchmark calls the error of a picture: relative MSE, the mean over pixels and
/// channels of (x − r)²/(r² + 0.01), without the worst 0.1 % of the pixels.
inline double error_of(const ImageComparison& with_reference) {
  return with_reference.relative_mse_trimmed;
}
inline double error_of(const Image& image, const Image& reference) {
  return error_of(compare_images(image, reference));
}

/// The picture's mean over the reference's, of all channels together.
inline double ratio_of_means(const ImageComparison& with_reference) {
  const Vec3d &mean = with_reference.mean, &wanted = with_reference.reference_mean;
  return (mean.x + mean.y + mean.z) / (wanted.x + wanted.y + wanted.z);
}

/// What came out of `seconds` of rendering.
struct Rendering {
  ImageComparison quality;
  double seconds = 0;  ///< what it really took, without building the scene
  double samples_per_pixel = 0;
  double error() const { return error_of(quality); }
};

inline Rendering render_for(const std::string& name, const std::string& integrator, double seconds,
                            const Image& reference) {
  Description description = load_shipped(name);
  override_integrator(description, integrator);
  const auto scene = build_scene(description);
  std::vector<std::string> warnings;
  const auto method = make_integrator(description, *scene, warnings);
  SessionSettings settings;
  settings.threads = picture_threads;
  settings.seconds = seconds;
  Session session(*scene, *method, settings);
  const SessionReport report = session.run();
  return {compare_images(session.film().image(), reference), report.seconds,
          double(report.passes) * report.samples_per_pass};
}

}  // namespace kaustik::bench
