// Photon mapping beside path tracing at equal time, against stored references (made by
// benchmarks/make_references.sh). `render_bench [seconds]`: 30 per picture unless told.
#include <cstdlib>

#include "benchmarks/quality.h"

namespace {

using namespace kaustik;

void compare_methods(const std::string& name, double seconds) {
  const std::optional<Image> reference = bench::reference_of(name);
  if (!reference) return;
  const bench::Rendering photonmap = bench::render_for(name, "photonmap", seconds, *reference);
  const bench::Rendering by_path = bench::render_for(name, "path", seconds, *reference);
  // Passes are whole, so both end somewhat early; unbiased error falls as 1/time.
  const double path_error = by_path.error() * by_path.seconds / photonmap.seconds;
  bench::report(
      name + "_photonmap_vs_path", path_error / photonmap.error(), "ratio of relative MSE",
      fmt::format("path: {:.3g} ({:.1f} s, brought to photonmap's time as 1/time), photonmap: "
                  "{:.3g} ({:.1f} s), {} threads; the reference itself: {:.2g}",
                  path_error, by_path.seconds, photonmap.error(), photonmap.seconds,
                  bench::picture_threads, own_relative_mse(*reference)));
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
