// Photon mapping beside path tracing at equal time, against stored references (made by
// benchmarks/make_references.sh). `render_bench [seconds]`: 30 per picture unless told.
#include <cstdlib>
#include <filesystem>

#include "benchmarks/report.h"
#include "benchmarks/shipped_scenes.h"
#include "kaustik/image/image_io.h"
#include "kaustik/image/metrics.h"
#include "kaustik/render/session.h"
#include "kaustik/scene/overrides.h"

namespace {

using namespace kaustik;

constexpr int threads = 2;

/// Relative MSE without the worst 0.1 % of the pixels, after `seconds` of rendering.
double error_of(const std::string& name, const std::string& integrator, double seconds,
                const Image& reference) {
  Description description = bench::load_shipped(name);
  override_integrator(description, integrator);
  const auto scene = build_scene(description);
  std::vector<std::string> warnings;
  const auto method = make_integrator(description, *scene, warnings);
  SessionSettings settings;
  settings.threads = threads;
  settings.seconds = seconds;
  Session session(*scene, *method, settings);
  session.run();
  return compare_images(session.film().image(), reference).relative_mse_trimmed;
}

/// The relative MSE of the reference itself, from its "error" layer (standard errors).
double error_of_reference(const Image& reference) {
  const RgbView value = rgb_view(reference), error = rgb_view(reference, "error");
  double sum = 0;
  for (size_t i = 0; i < reference.pixel_count(); ++i)
    for (size_t c = 0; c < 3; ++c)
      sum += sqr(error.planes[c][i]) / (sqr(value.planes[c][i]) + 0.01f);
  return sum / double(3 * reference.pixel_count());
}

void compare_methods(const std::string& name, double seconds) {
  const std::string path =
      std::string(KAUSTIK_SOURCE_DIR) + "/benchmarks/references/" + name + ".exr";
  if (!std::filesystem::exists(path)) {
    fmt::print(stderr, "render_bench: there is no {}; make it: benchmarks/make_references.sh 60m\n",
               path);
    return;
  }
  const Image reference = read_image(path);
  const double photonmap = error_of(name, "photonmap", seconds, reference);
  const double by_path = error_of(name, "path", seconds, reference);
  bench::report(
      name + "_photonmap_vs_path", by_path / photonmap, "ratio of relative MSE",
      fmt::format("path: {:.3g}, photonmap: {:.3g}, {:.0f} s on {} threads; the reference "
                  "itself: {:.2g}",
                  by_path, photonmap, seconds, threads, error_of_reference(reference)));
}

}  // namespace

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 30;
  try {
    for (const char* name : {"cornell_box", "metal_ring"}) compare_methods(name, seconds);
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
