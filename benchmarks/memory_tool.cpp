// Bytes a pixel that film, pass and splats take together at most, in scenes that ship, and in
// brackets what check_film_memory() foresees.
// `memory_tool [PASSES [SIZE [SCENE ...]]]`: 64 passes of 128 × 128 pixels if it is not told.
#include "benchmarks/markdown_table.h"
#include "benchmarks/shipped_scenes.h"
#include "kaustik/base/error.h"
#include "kaustik/integrator/override_integrator.h"
#include "kaustik/render/film_memory.h"
#include "kaustik/render/session.h"
#include "kaustik/scene/overrides.h"

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace {

using namespace kaustik;

std::string measured(const std::string& scene_name, const std::string& type, uint32_t passes,
                     int size) {
  Description description = bench::load_shipped(scene_name);
  override_integrator(description, type);
  override_property(description, fmt::format("film.width={}", size));
  override_property(description, fmt::format("film.height={}", size));
  const auto scene = build_scene(description);
  std::vector<std::string> warnings;
  const auto integrator = make_integrator(description, *scene, warnings);
  SessionSettings settings;
  settings.passes = passes;
  settings.samples_per_pass = 1;
  Session session(*scene, *integrator, settings);
  const SessionReport report = session.run();
  const FilmMemory expected =
      expected_film_memory(FilmLayers::of(*integrator), integrator->traits().splats);
  return fmt::format("{:.0f} ({:.0f})", double(report.rendering_bytes) / (size * size),
                     expected.rendering());
}

}  // namespace

int main(int argc, char** argv) {
  const int passes = argc > 1 ? std::atoi(argv[1]) : 64, size = argc > 2 ? std::atoi(argv[2]) : 128;
  if (passes < 1 || size < 1) {
    fmt::print(stderr, "usage: memory_tool [PASSES [SIZE [SCENE ...]]], both numbers at least 1\n");
    return 2;
  }
  std::vector<std::string> scenes(argv + std::min(3, argc), argv + argc);
  if (scenes.empty()) scenes = {"cornell_spheres", "metal_ring", "maze", "pool_below", "museum"};
  const std::vector<std::string> types = {"path", "bdpt",      "vcm",
                                          "auto", "photonmap", "lighttracer"};
  std::vector<std::string> header = {"scene"};
  for (const std::string& type : types) header.push_back("`" + type + "`");
  bench::MarkdownTable table(header);
  try {
    for (const std::string& scene : scenes) {
      std::vector<std::string> row = {scene};
      for (const std::string& type : types)
        row.push_back(measured(scene, type, uint32_t(passes), size));
      table.add(row);
    }
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
  fmt::print("{}", table.text());
  return 0;
}
