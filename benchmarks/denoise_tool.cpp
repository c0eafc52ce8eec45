// What denoising brings: relative MSE of pictures that ship, as rendered and denoised, against a
// picture of another seed that was rendered for long; and how often the denoised picture's error
// holds the truth. Errors are less the reference's own; "–": they are too near to it to be
// compared. `denoise_tool FOLDER [SECONDS [SCENE ...]]`: pictures are kept in the folder, and
// rendered if they are not there; references for so many seconds each, a minute if it is not told.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "benchmarks/markdown_table.h"
#include "benchmarks/quality.h"
#include "kaustik/base/error.h"
#include "kaustik/base/parallel.h"
#include "kaustik/image/denoise.h"
#include "kaustik/image/photometry.h"

namespace {

using namespace kaustik;

constexpr int side = 160;
constexpr uint32_t samples_per_pass = 4;
constexpr uint64_t reference_seed = 999;
constexpr uint32_t pass_counts[] = {1, 2, 4, 16, 64};
const std::vector<std::string> shown_scenes = {"cornell_box", "cornell_spheres", "metal_ring",
                                               "gallery_1",   "museum",          "atrium"};

Image rendered(const std::string& scene_name, const std::string& type,
               const SessionSettings& settings) {
  Description description = bench::load_shipped(scene_name);
  override_integrator(description, type);
  override_property(description, fmt::format("film.width={}", side));
  override_property(description, fmt::format("film.height={}", side));
  const auto scene = build_scene(description);
  std::vector<std::string> warnings;
  const auto integrator = make_integrator(description, *scene, warnings);
  Session session(*scene, *integrator, settings);
  session.run();
  return session.image();
}

Image kept(const std::filesystem::path& file, const std::function<Image()>& make) {
  if (std::filesystem::exists(file)) return read_image(file.string());
  WriteOptions options;
  options.exr_half = false;
  const Image image = make();
  write_image(image, file.string(), options);
  return image;
}

/// Of pixels, by the photopic value; the reference's own error is beside that of the picture.
double share_held(const Image& image, const Image& reference) {
  const RgbView shown = rgb_view(image), wanted = rgb_view(reference);
  const RgbView error = rgb_view(image, "denoised_error"), own = rgb_view(reference, "error");
  size_t held = 0;
  for (size_t i = 0; i < image.pixel_count(); ++i)
    held += std::fabs(photopic(shown[i]) - photopic(wanted[i])) <=
            1.96f * std::hypot(photopic(error[i]), photopic(own[i]));
  return double(held) / double(image.pixel_count());
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc < 2) throw Error(ErrorKind::input, "no folder is given for the pictures", "name one");
    const std::filesystem::path folder = argv[1];
    const double seconds = argc > 2 ? std::atof(argv[2]) : 60;
    std::filesystem::create_directories(folder);
    const std::vector<std::string> scenes =
        argc > 3 ? std::vector<std::string>(argv + 3, argv + argc) : shown_scenes;
    bench::MarkdownTable table({"scene", "integrator", "passes", "as rendered", "denoised",
                                "times less", "held, %", "ms"});
    for (const std::string& scene : scenes) {
      SessionSettings settings;
      settings.threads = bench::picture_threads;
      settings.seed = reference_seed;
      settings.seconds = seconds;
      settings.is_endless = true;
      const Image reference =
          kept(folder / (scene + ".exr"), [&] { return rendered(scene, "auto", settings); });
      const double own = own_relative_mse(reference);
      for (const std::string integrator : {"path", "auto"})
        for (const uint32_t passes : pass_counts) {
          SessionSettings short_ones;
          short_ones.threads = bench::picture_threads;
          short_ones.passes = passes;
          short_ones.samples_per_pass = samples_per_pass;
          const Image noisy = kept(folder / fmt::format("{}_{}_{}.exr", scene, integrator, passes),
                                   [&] { return rendered(scene, integrator, short_ones); });
          Image smooth;
          const double time = bench::seconds_of(
              [&] { with_threads(bench::picture_threads, [&] { smooth = denoise(noisy); }); });
          const double before = bench::error_of(noisy, reference) - own;
          const double after = bench::error_of(smooth, reference) - own;
          const bool has_error = smooth.find_channel("denoised_error.R") >= 0;
          table.add({scene, integrator, fmt::format("{}", passes), fmt::format("{:.5f}", before),
                     fmt::format("{:.5f}", after),
                     after > own / 2 ? fmt::format("{:.1f}", before / after) : "–",
                     has_error ? fmt::format("{:.0f}", 100 * share_held(smooth, reference)) : "–",
                     fmt::format("{:.0f}", 1000 * time)});
        }
      fmt::print(stderr, "{}: the reference's own {:.5f}\n", scene, own);
    }
    fmt::print("{}", table.text());
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
