// Where the time goes, and what the irradiance cache saves.
#include <fmt/format.h>

#include "benchmarks/markdown_table.h"
#include "benchmarks/quality.h"
#include "kaustik/image/metrics.h"
#include "sampling_profiler.h"
#include "scene_run.h"

namespace kaustik::thesis {
namespace {

/// A sample belongs to the first that is on the stack: a shadow ray of the light pass is the light
/// pass's.
const std::vector<ProfileStage>& profile_stages() {
  static const std::vector<ProfileStage> stages{
      {"light pass", {"LightPass"}},
      {"search for photons",
       {"9PhotonMap8radiance", "9PhotonMap10irradiance", "9PhotonMap4find", "13IrradianceMap"}},
      {"shadow rays", {"occluded"}},
      {"other rays", {"intersect", "rtcIntersect"}},
      {"irradiance cache", {"15IrradianceCache", "RecordOctree"}},
      {"light sampling", {"sample_direct_light", "sample_toward"}},
  };
  return stages;
}

struct StageCase {
  const char* scene;
  const char* title;
  std::vector<std::string> settings;
};

}  // namespace

std::string stages(const Workplace& place) {
  const std::vector<std::string> thesis{"integrator.preset=thesis",
                                        "integrator.caustic_neighbors=50",
                                        "integrator.specular_sampling=perfect"};
  auto thesis_cached = thesis;
  thesis_cached.push_back("integrator.irradiance_cache=true");
  const std::vector<StageCase> cases{
      {"cornell_box", "Cornell box, default", {}},
      {"cornell_box", "Cornell box, thesis, cache", thesis_cached},
      {"cornell_box", "Cornell box, thesis, no cache", thesis},
      {"metal_ring", "metal ring, default, 200 found", {"integrator.caustic_neighbors=200"}},
      {"metal_ring",
       "metal ring, thesis, 200 found",
       {"integrator.preset=thesis", "integrator.irradiance_cache=true",
        "integrator.caustic_neighbors=200", "integrator.specular_sampling=perfect"}},
  };
  std::vector<std::string> header{"scene, parameters"};
  for (const ProfileStage& stage : profile_stages()) header.push_back(stage.title);
  header.push_back("rest");
  header.push_back("clock samples");
  bench::MarkdownTable table(header);
  for (const StageCase& one : cases) {
    say(fmt::format("stages: {}", one.title));
    const SceneRun run(one.scene, {"photonmap", one.settings, 256, 256});
    SamplingProfiler profiler;
    run.render(in_passes(uint32_t(place.scaled(16)), 1, 1, 1));
    std::vector<std::string> row{one.title};
    for (const double share : profiler.shares(profile_stages()))
      row.push_back(fmt::format("{:.0f} %", 100 * share));
    row.push_back(fmt::format("{}", profiler.sample_count()));
    table.add(row);
  }
  return "Shares of the time on one thread, light pass and cache included, by asking the "
         "processor's "
         "clock every 2 ms which function runs.\nThe thesis finds that searching photons takes "
         "little, and that shadow rays and intersections dominate.\n\n" +
         table.text();
}

std::string irradiance_cache(const Workplace& place) {
  const Image truth = reference(place, "cornell_box_whole", [&] {
    const SceneRun run("cornell_box", {"path", {}, 256, 256});
    return run.render(in_passes(uint32_t(place.scaled(4096)), 2, 999, place.threads)).image;
  });
  bench::MarkdownTable table(
      {"parameters", "cache", "s", "rays per pixel", "relative MSE", "relative MSE × s"});
  const auto row = [&](const char* title, bool cached, std::vector<std::string> settings) {
    settings.push_back(fmt::format("integrator.irradiance_cache={}", cached));
    const SceneRun run("cornell_box", {"photonmap", settings, 256, 256});
    const auto result = run.render(in_passes(uint32_t(place.scaled(4)), 1, 1, place.threads));
    const double error = bench::error_of(result.image, truth);
    table.add({title, cached ? "on" : "off", fmt::format("{:.2f}", result.report.seconds),
               fmt::format("{:.1f}", double(result.report.rays) / (256 * 256)),
               fmt::format("{:.2g}", error), fmt::format("{:.2g}", error * result.report.seconds)});
    say(fmt::format("cache: {} {}", title, cached));
  };
  for (const bool cached : {true, false}) {
    row("default", cached, {});
    row("thesis (50 gather rays)", cached, {"integrator.preset=thesis"});
  }
  return "The Cornell box, 256×256 pixels, one pass with 4 camera samples per pixel. Without the "
         "cache every camera sample gathers\nby itself (4 rays by default, 50 in the thesis).\n\n" +
         table.text();
}

std::string maze_cache_quality(const Workplace& place) {
  const Image truth = reference(place, "maze_whole", [&] {
    const SceneRun run("maze", {"path", {}, 256, 256});
    return run.render(in_passes(uint32_t(place.scaled(2048)), 2, 999, place.threads)).image;
  });
  bench::MarkdownTable table({"`cache_quality`", "s", "rays per pixel",
                              "relative MSE of indirect light", "of the picture"});
  for (const char* quality : {"1", "0.5", "0.25", "0.12", "0.06"}) {
    const SceneRun run(
        "maze", {"photonmap", {fmt::format("integrator.cache_quality={}", quality)}, 256, 256});
    const auto result = run.render(in_passes(16, 1, 1, place.threads));
    table.add(
        {quality, fmt::format("{:.2f}", result.report.seconds),
         fmt::format("{:.1f}", double(result.report.rays) / (256 * 256)),
         fmt::format("{:.2g}", bench::error_of(compare_images(result.image, truth, "indirect"))),
         fmt::format("{:.2g}", bench::error_of(result.image, truth))});
    say(fmt::format("maze: quality {}", quality));
  }
  return "The maze, 256×256 pixels, one pass with 16 camera samples per pixel, by the allowed "
         "error "
         "of the irradiance cache (smaller\nis finer). The thesis needed a high quality here, and "
         "paid with time.\n\n" +
         table.text();
}

}  // namespace kaustik::thesis
