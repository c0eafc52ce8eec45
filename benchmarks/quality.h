#pragma once
// How far pictures are from stored references (made by benchmarks/make_references.sh).
#include <filesystem>
#include <optional>

#include "benchmarks/report.h"
#include "benchmarks/shipped_scenes.h"
#include "kaustik/image/image_io.h"
#include "kaustik/image/metrics.h"
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

/// What came out of `seconds` of rendering.
struct Rendering {
  ImageComparison quality;
  double seconds = 0;  ///< what it really took, without building the scene
  double samples_per_pixel = 0;
  /// Relative MSE without the worst 0.1 % of the pixels.
  double error() const { return quality.relative_mse_trimmed; }
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

/// The relative MSE of the reference itself, from its "error" layer (standard errors), without the
/// worst 0.1 % of the pixels as everywhere.
inline double error_of_reference(const Image& reference) {
  const RgbView value = rgb_view(reference), error = rgb_view(reference, "error");
  std::vector<double> errors(reference.pixel_count());
  for (size_t i = 0; i < errors.size(); ++i)
    for (size_t c = 0; c < 3; ++c)
      errors[i] += sqr(error.planes[c][i]) / (sqr(value.planes[c][i]) + 0.01f) / 3;
  return trimmed_mean(std::move(errors));
}

}  // namespace kaustik::bench
