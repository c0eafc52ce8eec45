// Photon mapping beside path tracing at equal time, against stored references (made by
// benchmarks/make_references.sh). `render_bench [seconds]`: 30 per picture unless told.
#include <cstdlib>

#include "benchmarks/quality.h"

namespace {

using namespace kaustik;

void compare_methods(const std::string& name, double seconds) {
  const std::optional<Image> reference = bench::reference_of(name);
  if (!reference) return;
  const double photonmap = bench::render_for(name, "photonmap", seconds, *reference).error();
  const double by_path = bench::render_for(name, "path", seconds, *reference).error();
  bench::report(
      name + "_photonmap_vs_path", by_path / photonmap, "ratio of relative MSE",
      fmt::format("path: {:.3g}, photonmap: {:.3g}, {:.0f} s on {} threads; the reference "
                  "itself: {:.2g}",
                  by_path, photonmap, seconds, bench::picture_threads,
                  bench::error_of_reference(*reference)));
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
