// Path tracing beside Blender Cycles on the Cornell box at equal time, start-up excluded.
// `cycles_bench [seconds [reference.exr]]`: 30 per picture, and the stored reference unless told.
// Cycles gets the scene as Kaustik has loaded it (RGB, as both compute), by benchmarks/peers.
#include <cstdlib>

#include "benchmarks/peers/cycles.h"
#include "benchmarks/quality.h"

namespace {

using namespace kaustik;

constexpr const char* scene_name = "cornell_box";
/// The means of both pictures may differ by this; otherwise they are not of the same scene.
constexpr double mean_tolerance = 0.005;

/// Cycles' picture of our scene.
bench::PeerPicture render_with_cycles(double seconds, int seed) {
  Description description = bench::load_shipped(scene_name);
  bench::use_peer_filter(description);
  return bench::render_with_cycles(bench::peer_scene_of(*build_scene(description)), seconds,
                                   bench::picture_threads, seed);
}

void throw_unless_same_scene(const ImageComparison& with_reference) {
  for (int c = 0; c < 3; ++c)
    if (std::abs(with_reference.mean_ratio[c] - 1) > mean_tolerance)
      throw Error(ErrorKind::system,
                  fmt::format("Cycles' picture is {:.3f} times as bright as the reference in "
                              "channel {}: not the same scene",
                              with_reference.mean_ratio[c], c));
}

/// The relative MSE of one of two independent pictures of the same mean, by their difference: what
/// the conversion of the scene may have changed does not count as error.
double noise_of(const Image& a, const Image& b, const Image& reference) {
  const RgbView x = rgb_view(a), y = rgb_view(b), r = rgb_view(reference);
  std::vector<double> errors(reference.pixel_count());
  for (size_t i = 0; i < errors.size(); ++i)
    for (size_t c = 0; c < 3; ++c)
      errors[i] += sqr(x.planes[c][i] - y.planes[c][i]) / 2 / (sqr(r.planes[c][i]) + 0.01f) / 3;
  return trimmed_mean(std::move(errors));
}

void compare_with_cycles(double seconds, const Image& reference) {
  const bench::PeerPicture cycles = render_with_cycles(seconds, 1);
  const bench::PeerPicture again = render_with_cycles(seconds, 2);
  const ImageComparison with_reference = compare_images(cycles.image, reference);
  throw_unless_same_scene(with_reference);
  const bench::Rendering path = bench::render_for(scene_name, "path", seconds, reference);
  // Both are unbiased: their error falls as 1/time, by which the rest of the difference in time is
  // made good.
  const double noise = noise_of(cycles.image, again.image, reference);
  const double cycles_error = noise * (cycles.seconds + again.seconds) / 2 / path.seconds;
  bench::report(
      "path_vs_cycles", cycles_error / path.error(), "ratio of relative MSE",
      fmt::format("Cycles: {:.3g} ({} in {:.2f} s, brought to path's time as "
                  "1/time, from the difference of two pictures; {:.3g} from the reference), path: "
                  "{:.3g} ({:.0f} in {:.2f} s), {} threads, start-up excluded, no denoiser, no "
                  "clamping; the reference itself: {:.2g}",
                  cycles_error, cycles.effort, cycles.seconds, bench::error_of(with_reference),
                  path.error(), path.samples_per_pixel, path.seconds, bench::picture_threads,
                  own_relative_mse(reference)));
}

}  // namespace

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 30;
  try {
    if (!bench::is_installed("blender")) {
      fmt::print(stderr,
                 "there is no blender to compare with; on Debian: apt-get install blender\n");
      return 0;
    }
    const std::optional<Image> reference =
        argc > 2 ? read_image(argv[2]) : bench::reference_of(scene_name);
    if (reference) compare_with_cycles(seconds, *reference);
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
