// How long the parts of a pass of `auto` take, in rays of the camera's paths: what CostModel has.
// Prints a row per scene, and the medians. By CPU time of one thread. `cost_tool [SCENE ...]`:
// names as of bench_scenes.
//
// With T the time of a camera sample and R its rays, both without light paths, a ray takes
// (T - T')/(R - R'), where ' is direct light alone. The same samples take longer where light
// merges: by a line over the light vertices that merge at a vertex, of which there are (R - 1)/2, a
// ray to each and one from it to a lamp. How many merge is what plans expect at the first vertex;
// disks are made for 10, 30, 100 and 300 of them. Rays that gather take what a pass takes longer
// with a cache than without one before its first sample, over their number.
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>

#include "benchmarks/comparisons/bench_scene.h"
#include "benchmarks/markdown_table.h"
#include "benchmarks/report.h"
#include "kaustik/base/parallel.h"
#include "kaustik/integrator/override_integrator.h"
#include "kaustik/loader/scene_format.h"
#include "kaustik/render/session.h"
#include "kaustik/scene/overrides.h"
#include "kaustik/vcm/plan/cost_model.h"
#include "kaustik/vcm/plan/plans.h"

namespace {

using namespace kaustik;

constexpr int size = 128;
constexpr uint32_t passes = 3, samples = 4;
constexpr std::array neighbors = {10, 30, 100, 300};

double cpu_seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }

struct Cost {
  double seconds = 0, rays = 0;  ///< of a camera sample
  double light_seconds = 0, light_rays = 0;
};

/// Anew each time, since what is overridden stays.
Description description_of(const std::string& name) {
  Description description = load_scene(bench::bench_scene(name).file);
  override_property(description, fmt::format("film.width={}", size));
  override_property(description, fmt::format("film.height={}", size));
  return description;
}

std::unique_ptr<Integrator> made(Description description, const Scene& scene,
                                 const std::string& type,
                                 const std::vector<std::string>& settings) {
  override_integrator(description, type);
  for (const std::string& setting : settings)
    override_property(description, "integrator." + setting);
  std::vector<std::string> warnings;
  return make_integrator(description, scene, warnings);
}

/// Of passes after the first, whose plans are made once.
Cost cost_of(const Integrator& integrator) {
  Cost cost;
  for (uint32_t index = 0; index <= passes; ++index) {
    const Pass pass{1, index, samples, {}};
    SplatBuffer splats = SplatBuffer::nowhere();
    const double begin = cpu_seconds();
    const auto state = integrator.prepare(pass, splats, {}, {});
    const double prepared = cpu_seconds();
    if (index == 0) continue;
    cost.light_seconds += prepared - begin;
    cost.light_rays += double(state->report.rays);
    for (uint64_t pixel = 0; pixel < uint64_t(size) * size; ++pixel)
      for (uint32_t i = 0; i < samples; ++i) {
        Sampler sampler = Sampler::at(1, index, Stream::camera, pixel, i);
        SampleSink sink(ComponentSet::all());
        const Vec2f u = sampler.next_2d();
        integrator.sample(*state, Vec2f(float(pixel % size), float(pixel / size)) + u, sampler,
                          sink);
        cost.rays += double(sink.rays());
      }
    cost.seconds += cpu_seconds() - prepared;
  }
  const double all = double(passes) * samples * size * size;
  cost.seconds /= all;
  cost.rays /= all;
  return cost;
}

/// Light vertices that are expected to merge at a sample's first vertex.
double merged(const Scene& scene, int merge_neighbors) {
  Problems problems;
  VcmSettings settings(Arguments(ppm_info(), {}, {}, problems));
  settings.light_paths = 1;
  settings.merge_neighbors = merge_neighbors;
  settings.learn_radii = false;
  const auto plain = std::make_shared<const LightPathEmission>(scene, settings.aim);
  const VcmPlans plans = *VcmPlanner(scene, settings, plain).make(samples, {}).plans;
  double sum = 0;
  for (const ProbeStatistics& probe : plans.pilot->probes) sum += probe.merged;
  return sum / double(std::max<size_t>(1, plans.pilot->probes.size()));
}

struct Line {
  double at_zero = 0, slope = 0;
};
/// Least squares of relative errors would favour none; these are plain.
Line line_through(const std::vector<double>& x, const std::vector<double>& y) {
  double mean_x = 0, mean_y = 0, xx = 0, xy = 0;
  for (size_t i = 0; i < x.size(); ++i) {
    mean_x += x[i] / double(x.size());
    mean_y += y[i] / double(x.size());
  }
  for (size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  return {mean_y - xy / xx * mean_x, xy / xx};
}

/// merging, merged_vertex, light_ray and gather_ray of CostModel, then seconds of a ray.
using Parts = std::array<double, 5>;

/// Seconds of a ray that gathers, with all that is done at its end.
double gather_seconds(const std::string& name, const Scene& scene) {
  const auto with = [&](const std::string& use) {
    return cost_of(*made(description_of(name), scene, "ppm", {"indirect_cache=" + use}));
  };
  const Cost never = with("never"), always = with("always");
  return (always.light_seconds - never.light_seconds) / (always.light_rays - never.light_rays);
}

Parts parts_of(const std::string& name) {
  const auto scene = build_scene(description_of(name));
  const std::vector<std::string> alone = {"merging=false", "splats=false", "connections=false"};
  const Cost whole = cost_of(*made(description_of(name), *scene, "vcm", alone));
  std::vector<std::string> direct = alone;
  direct.push_back("max_depth=2");
  const Cost short_paths = cost_of(*made(description_of(name), *scene, "vcm", direct));
  const double ray = (whole.seconds - short_paths.seconds) / (whole.rays - short_paths.rays);
  const double vertices = std::max(1.0, (whole.rays - 1) / 2);
  std::vector<double> counts, rays;
  double light = 0;
  for (const int count : neighbors) {
    const Cost merging = cost_of(
        *made(description_of(name), *scene, "ppm",
              {"light_paths=1", "adaptive=false", "learn_radii=false", "choose_survival=false",
               "choose_light_samples=false", fmt::format("merge_neighbors={}", count)}));
    counts.push_back(merged(*scene, count));
    rays.push_back((merging.seconds - whole.seconds) / ray / vertices);
    light += merging.light_seconds / merging.light_rays / ray / double(neighbors.size());
  }
  const Line line = line_through(counts, rays);
  return {line.at_zero, line.slope, light, gather_seconds(name, *scene) / ray, ray};
}

std::vector<std::string> row_of(const std::string& name, const Parts& parts) {
  std::vector<std::string> row = {name};
  for (size_t i = 0; i < 4; ++i) row.push_back(fmt::format("{:.3g}", parts[i]));
  row.push_back(fmt::format("{:.0f}", 1e9 * parts[4]));
  return row;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> scenes(argv + 1, argv + argc);
  if (scenes.empty())
    scenes = {"cornell_box", "cornell_spheres",    "metal_ring",     "museum",
              "atrium",      "pool_below",         "maze",           "gallery_1",
              "door_ajar",   "peer_cornell_glass", "peer_pool_above"};
  bench::MarkdownTable table(
      {"scene", "merging", "merged vertex", "light ray", "gather ray", "ray, ns"});
  std::array<std::vector<double>, 5> all;
  try {
    with_threads(1, [&] {
      for (const std::string& name : scenes) {
        const Parts parts = parts_of(name);
        table.add(row_of(name, parts));
        fmt::print(stderr, "# {}: {:.3g}\n", name, fmt::join(parts, ", "));
        for (size_t i = 0; i < parts.size(); ++i) all[i].push_back(parts[i]);
      }
    });
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
  Parts medians;
  for (size_t i = 0; i < medians.size(); ++i) medians[i] = bench::median(all[i]);
  table.add(row_of("median", medians));
  table.add({"CostModel", fmt::format("{:g}", cost_model.merging),
             fmt::format("{:g}", cost_model.merged_vertex),
             fmt::format("{:g}", cost_model.light_ray), fmt::format("{:g}", cost_model.gather_ray),
             ""});
  fmt::print("{}", table.text());
  return 0;
}
