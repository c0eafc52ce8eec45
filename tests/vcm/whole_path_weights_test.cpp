// The weights of all ways of finding one path sum to 1 where the code that
// renders finds it: camera paths and light paths know the same densities, with
// what was learned of emission and scattering, masks and sheets that paths
// pass, splats, and a radius for every pixel.

#include <algorithm>
#include <random>

#include "kaustik/vcm/lessons/emission_learning.h"
#include "kaustik/vcm/lessons/scatter_learning.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"
#include "tests/vcm/whole_paths.h"

namespace kaustik {
namespace {

using namespace test;

constexpr uint32_t training_paths = 30'000;
constexpr uint32_t traced_paths = slow_build ? 500 : 2000;
constexpr double weight_tolerance = 1e-4;

const std::string clear_glass = R"(<bsdf type="dielectric"><float name="int_ior" value="1"/>
    <float name="ext_ior" value="1"/></bsdf>)";
/// Light goes straight on through holes without an event.
std::string mask(double opacity) {
  return fmt::format(
      R"(<bsdf type="mask"><float name="opacity" value="{}"/><bsdf type="twosided">{}</bsdf></bsdf>)",
      opacity, diffuse("0.7, 0.7, 0.7"));
}
/// The same share goes straight on by a delta event: through glass of index 1.
std::string half_glass(double opacity) {
  return fmt::format(
      R"(<bsdf type="blendbsdf"><float name="weight" value="{}"/>{}<bsdf type="twosided">{}</bsdf></bsdf>)",
      opacity, clear_glass, diffuse("0.7, 0.7, 0.7"));
}
std::string sheet() {
  return R"(<bsdf type="thinphong"><rgb name="diffuse_reflectance" value="0.4"/>
      <rgb name="diffuse_transmittance" value="0.5"/></bsdf>)";
}

/// Matt and glossy surfaces; a sheet that light passes by diffuse events;
/// half glass and masks, which hide a part from the camera, too.
std::string surfaces() {
  return camera("0, -2.6, 1.2", "0, 0, 0.8", 60, 32) +
         flat("rectangle", scale("3, 3, 1"), diffuse("0.6, 0.6, 0.6")) +
         flat("rectangle", scale("3, 2, 1") + rotate("1, 0, 0", 90) + translate("0, 2, 1"),
              phong(0.4, 0.4, 12)) +
         flat("rectangle", scale("1, 3, 1") + rotate("0, 1, 0", 90) + translate("-2, 0, 1"),
              diffuse("0.6, 0.6, 0.6")) +
         flat("cube", scale("0.25, 0.25, 0.25") + translate("0.6, 0.4, 0.25"),
              diffuse("0.6, 0.6, 0.6")) +
         sphere("-0.6, 0.5, 0.4", 0.4, diffuse("0.6, 0.6, 0.6")) +
         flat("rectangle", scale("0.5, 0.5, 1") + translate("-1.2, 0.4, 1.5"), sheet()) +
         flat("rectangle", scale("0.5, 0.5, 1") + translate("0.9, 0.2, 1.2"), half_glass(0.5)) +
         flat("rectangle", scale("0.4, 0.4, 1") + rotate("1, 0, 0", 90) + translate("0.5, -1.8, 1"),
              half_glass(0.4)) +
         flat("rectangle", scale("0.3, 0.3, 1") + translate("-0.3, -0.4, 0.9"), mask(0.4)) +
         flat("rectangle", scale("0.15, 0.15, 1") + rotate("1, 0, 0", 90) + translate("0, -1.6, 1"),
              mask(0.5));
}
/// A lamp above a pane of glass, and a bare point.
std::string lamps_in_a_room() {
  return surfaces() + flat("cube", scale("0.6, 0.6, 0.02") + translate("0, 0.6, 1.9"), glass()) +
         flat("rectangle", scale("0.4, 0.4, 1") + rotate("1, 0, 0", 180) + translate("0, 0.3, 2.5"),
              diffuse("0, 0, 0") + area_light("10")) +
         point_light("-1.2, -0.5, 1.8", 3);
}
/// The sun, the sky, and a ball.
std::string lights_outside() {
  return surfaces() + sphere("0.5, 0.4, 1.8", 0.2, diffuse("0, 0, 0") + area_light("30")) +
         directional_light("0.3, 0.2, -1", 1) + constant_light(0.05);
}

Techniques every_technique() { return {.splats = true, .connections = true, .merging = true}; }

PathWeights path_weights_by(const Techniques& techniques) {
  PathWeights::Settings settings;
  settings.techniques = techniques;
  settings.light_paths = 20'000;
  settings.connections = 0.5f;
  settings.merge_area = pi * sqr(0.012f);
  settings.accepted_area = 0.5f;
  settings.least_spread = 0.02f;
  return PathWeights(settings);
}

/// Another for every block of pixels.
PixelPlans plans_of(const Scene& scene) {
  std::mt19937 numbers(3);
  const auto next = [&] { return float(numbers() >> 8) * 0x1p-24f; };
  const PixelPlans plain(scene);
  std::vector<PixelPlan> different(plain.plans().size());
  for (PixelPlan& plan : different) {
    plan.merge_area = pi * sqr(0.004f + 0.016f * next());
    plan.survival = 0.1f + 0.9f * next();
    plan.glossy_survival = 1.1f - plan.survival;
    plan.evenness = 0.3f + 0.7f * next();
    plan.covered = 0.2f + 0.8f * next();
    plan.merging_in_common = 1 + next();
    plan.light_samples = 1 + int(4 * next());
  }
  return plain.with(std::move(different));
}

/// Where light is of use: a corner of the floor, and for emission, which learns
/// from less, a part of it.
constexpr Vec3f corner(1, 1, 0);
constexpr float corner_radius = 0.7f, part_radius = 0.4f;

/// Emission and scattering as paths that came there have taught.
void learn(WholePathRules& rules) {
  const std::shared_ptr<const LightPathEmission> plain = rules.emission;
  SplatBuffer nowhere(rules.scene.film(), ComponentSet());
  const LightVertices light = rules.trace({9, 0, 1}, training_paths, nowhere);
  const auto& tree = light.tree.tree();
  /// Vertices before the last of use, by path.
  const auto last_within = [&](float radius) {
    std::vector<uint32_t> last(light.vertices.size());
    for (uint32_t i = 0; i < tree.size(); ++i)
      if (length_sq(tree.key(i) - corner) < sqr(radius))
        last[tree.data(i).path] = std::max<uint32_t>(last[tree.data(i).path], tree.data(i).before);
    return last;
  };
  const std::vector<uint32_t> last = last_within(corner_radius), in_part = last_within(part_radius);
  EmissionLearning emission(*plain);
  ScatterLearning scattering;
  for (const LightPathBeginning& path : light.beginnings)
    if (in_part[path.path] > 0) emission.add(path.start, double(path.start.emitted.flux.sum()));
  for (const LightScattering& event : light.scatterings)
    if (event.at < last[event.path]) scattering.add(event, 1, 1);
  const auto learned_emission = emission.learned();
  const auto learned_scattering = scattering.learned();
  if (learned_emission) rules.emission = learned_emission;
  rules.scattering = learned_scattering;
}

struct Guided {
  explicit Guided(const std::string& inside)
      : scene(inside),
        plain(std::make_shared<const LightPathEmission>(scene.scene())),
        rules{scene.scene(), path_weights_by(every_technique()), plans_of(scene.scene()), plain,
              nullptr} {
    learn(rules);
  }
  /// The same with other techniques.
  WholePathRules with(const Techniques& techniques) const {
    WholePathRules result = rules;
    result.weights = path_weights_by(techniques);
    return result;
  }
  TestScene scene;
  std::shared_ptr<const LightPathEmission> plain;
  WholePathRules rules;
};

/// What was found of the sums.
struct Sums {
  int paths = 0, off = 0;
  double largest = 0;
  std::array<int, 5> by{};  ///< paths that a technique counts for
  int guided = 0;           ///< paths with an event that is guided
  int delta = 0;            ///< … that passes glass or a mask
  std::string worst;

  void add(const WholePathWeights& weights, const std::string& what) {
    ++paths;
    for (const WholePathWeights::Part& part : weights.parts)
      if (part.weight > 0.01) ++by[size_t(part.by)];
    const double error = std::fabs(weights.sum() - 1);
    if (!(error <= weight_tolerance + weights.rounding)) ++off;
    if (error - weights.rounding <= largest) return;
    largest = error - weights.rounding;
    worst = what + weights.text();
  }
};

/// Of paths by `light`, where camera paths go by `camera`.
Sums sums(const WholePathRules& light, const WholePathRules& camera,
          uint32_t count = traced_paths) {
  Sums result;
  for (uint32_t i = 0; i < count; ++i) {
    const LonePath lone(light, i);
    for (size_t m = 1; m < lone.size(); ++m) {
      if (!lone.is_seen(m)) continue;
      const WholePath path(light, lone, m);
      if (!path.is_complete()) continue;
      const auto weights = weights_of(camera, path);
      if (!weights) continue;
      result.add(*weights, fmt::format("light path {}, vertex {} of {}: ", i, m, path.size()));
      bool is_guided = false, is_delta = false;
      for (const WholePathStep& step : path.steps()) {
        is_delta = is_delta || step.delta;
        if (step.delta || step.light == 0 || step.light == m || !light.scattering) continue;
        const SurfaceVertex& vertex = lone.at(step.light)->vertex;
        is_guided = is_guided || light.scattering->place(vertex, vertex.wo()).guided() > 0;
      }
      result.guided += is_guided ? 1 : 0;
      result.delta += is_delta ? 1 : 0;
    }
  }
  return result;
}

void expect_sums_of_one(const Guided& guided, int least_of_each) {
  const Sums all = sums(guided.rules, guided.rules);
  EXPECT_EQ(all.off, 0) << all.worst;
  EXPECT_GT(all.paths, int(traced_paths / 4));
  EXPECT_GT(all.guided, int(traced_paths / 30));
  // Of what is told by rounding there is little.
  EXPECT_GT(all.delta, int(traced_paths / 40));
  for (size_t i = 0; i < all.by.size(); ++i) EXPECT_GT(all.by[i], least_of_each) << found_names[i];
  const Techniques some[] = {{.splats = true, .connections = true}, {.merging = true}};
  for (const Techniques& techniques : some) {
    const WholePathRules rules = guided.with(techniques);
    const Sums found = sums(rules, rules, traced_paths / 4);
    EXPECT_EQ(found.off, 0) << found.worst;
    EXPECT_GT(found.paths, int(traced_paths / 50));
  }
}

TEST(WholePathWeights, SumToOneInARoom) {
  const Guided guided(lamps_in_a_room());
  ASSERT_NE(guided.rules.emission, guided.plain);
  ASSERT_TRUE(guided.rules.scattering);
  expect_sums_of_one(guided, int(traced_paths / 50));
}
TEST(WholePathWeights, SumToOneOutside) {
  expect_sums_of_one(Guided(lights_outside()), int(traced_paths / 60));
}

/// Where camera paths know nothing of what one side has learned, or of what is
/// decided for their pixels, they don't.
TEST(WholePathWeights, NoticeWhatIsForgotten) {
  const Guided guided(lamps_in_a_room());
  // By one path in so many at least.
  const auto expect_noticed = [&](const std::string& name, const WholePathRules& camera,
                                  int one_in = 20) {
    const Sums found = sums(guided.rules, camera, traced_paths / 4);
    EXPECT_GT(found.largest, 100 * weight_tolerance) << name;
    EXPECT_GE(found.off, std::max(1, found.paths / one_in)) << name;
  };
  const auto with_plans = [&](float survival, float disk) {
    std::vector<PixelPlan> plans = guided.rules.plans.plans();
    for (PixelPlan& plan : plans) {
      if (survival > 0) plan.survival = plan.glossy_survival = plan.evenness = survival;
      plan.merge_area *= disk;
    }
    WholePathRules camera = guided.rules;
    camera.plans = guided.rules.plans.with(std::move(plans));
    return camera;
  };
  WholePathRules unguided = guided.rules;
  unguided.scattering = nullptr;
  expect_noticed("without scattering", unguided);
  WholePathRules plain = guided.rules;
  plain.emission = guided.plain;
  expect_noticed("without emission", plain);
  expect_noticed("without survival", with_plans(1, 1));
  WholePathRules all_alike = guided.rules;
  std::vector<PixelPlan> plans = guided.rules.plans.plans();
  for (PixelPlan& plan : plans) plan.glossy_survival = plan.survival;
  all_alike.plans = guided.rules.plans.with(std::move(plans));
  expect_noticed("without a chance of glossy lobes", all_alike, 50);  // few surfaces are glossy
  expect_noticed("with other disks", with_plans(0, 8));
}

}  // namespace
}  // namespace kaustik
