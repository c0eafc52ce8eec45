// Where a pass of `ppm` spends its time: cornell_spheres in 512 x 512, one sample per pixel and as
// many light paths.
#include "benchmarks/report.h"
#include "benchmarks/shipped_scenes.h"
#include "kaustik/base/parallel.h"
#include "kaustik/integrator/override_integrator.h"
#include "kaustik/render/session.h"
#include "kaustik/scene/overrides.h"
#include "kaustik/vcm/light_pass.h"
#include "kaustik/vcm/merging/matt_merging.h"
#include "kaustik/vcm/plan/plans.h"

namespace {

using namespace kaustik;

constexpr int size = 512, repeats = 3;

/// The median of a few runs, each of a pass of its own.
template <typename Body>
double seconds_per_pass(const Body& body) {
  std::vector<double> seconds;
  for (uint32_t i = 0; i < repeats; ++i) {
    Pass pass;
    pass.index = i;
    seconds.push_back(bench::seconds_of([&] { body(pass); }));
  }
  return bench::median(seconds);
}

/// Seconds for the samples of all pixels, without a film.
double camera_seconds(const Integrator& integrator, const PassState& state) {
  return bench::seconds_of([&] {
    parallel_blocks(size, 1, [&](size_t begin, size_t end, size_t) {
      for (size_t y = begin; y < end; ++y)
        for (size_t x = 0; x < size; ++x) {
          Sampler sampler = Sampler::at(1, 0, Stream::camera, y * size + x, 0);
          SampleSink sink(ComponentSet::all());
          const Vec2f u = sampler.next_2d();
          integrator.sample(state, Vec2f(float(x), float(y)) + u, sampler, sink);
        }
    });
  });
}

/// Of an integrator with these settings and all that it has prepared.
double camera_seconds(Description description, const Scene& scene, const std::string& type,
                      const std::vector<std::string>& settings) {
  override_integrator(description, type);
  for (const std::string& setting : settings)
    override_property(description, "integrator." + setting);
  std::vector<std::string> warnings;
  const auto integrator = make_integrator(description, scene, warnings);
  SplatBuffer splats = SplatBuffer::nowhere();
  const auto state = integrator->prepare(Pass(), splats, {}, {});
  return camera_seconds(*integrator, *state);
}

void report(const std::string& stage, double seconds, const std::string& what) {
  bench::report("pass_" + stage, 1000 * seconds, "ms", what);
}

}  // namespace

int main() {
  Description description = bench::load_shipped("cornell_spheres");
  override_property(description, fmt::format("film.width={}", size));
  override_property(description, fmt::format("film.height={}", size));
  const auto scene = build_scene(description);
  Problems problems;
  VcmSettings settings(Arguments(ppm_info(), {}, {}, problems));
  settings.light_paths = 1;
  const auto plain = std::make_shared<const LightPathEmission>(*scene, settings.aim);
  VcmPlans plans;
  const double planning =
      bench::seconds_of([&] { plans = *VcmPlanner(*scene, settings, plain).make(1, {}).plans; });
  report("plans", planning, "once: pilots of light paths and camera paths, edges");

  PathWeights::Settings of_weights;
  of_weights.techniques = plans.techniques;
  const uint32_t light_paths = light_path_count({size, size}, 1, settings.light_paths);
  of_weights.light_paths = float(light_paths);
  of_weights.merge_area = plans.pixels.other_area();
  of_weights.accepted_area = accepted_area(plans.pixels);
  const PathWeights weights(of_weights);
  LightVertices light;
  const double tracing = seconds_per_pass([&](const Pass& pass) {
    SplatBuffer nowhere = SplatBuffer::nowhere();
    PassReport of_pass;
    light = trace_light_vertices({.scene = *scene,
                                  .emission = *plans.guides.emission,
                                  .weights = weights,
                                  .components = settings.components,
                                  .maximum_events = settings.maximum_events,
                                  .light_paths = light_paths,
                                  .plans = plans.pixels},
                                 pass, Stream::light_path, nowhere, {}, {}, of_pass);
  });
  const std::span<const LightVertexData> all = light.tree.tree().data();
  std::vector<Vec3f> positions;
  for (uint32_t i = 0; i < all.size(); ++i) positions.push_back(light.tree.tree().key(i));
  const double sorting = seconds_per_pass([&](const Pass&) {
    const SidedTree<LightVertexData> tree(positions, {all.begin(), all.end()});
  });
  const double laying_out =
      seconds_per_pass([&](const Pass&) { const MattMerging matt(light, weights); });
  report("light_paths", tracing - sorting,
         fmt::format("{} light paths, {} vertices", light_paths, light.tree.size()));
  report("tree", sorting, "the vertices sorted into their tree");
  report("lanes", laying_out, "laid out for matt surfaces");
  report("camera", camera_seconds(description, *scene, "ppm", {"light_paths=1"}),
         fmt::format("{} camera paths with direct light and merging", size * size));
  report("camera_path", camera_seconds(description, *scene, "path", {}),
         "the same of path tracing, for comparison");
  return 0;
}
