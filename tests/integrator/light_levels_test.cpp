// The recursion level of a path as lights hear of it, and that what they do with it changes no
// mean.

#include <array>
#include <atomic>
#include <set>

#include "kaustik/scene/scene_builder.h"
#include "tests/integrator/media_scenes.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"
#include "tests/support/strip_mesh.h"

namespace kaustik {
namespace {

using namespace test;

struct Levels {
  std::array<std::atomic<int>, 16> sampled{}, asked{};

  static std::set<int> seen(const std::array<std::atomic<int>, 16>& counts) {
    std::set<int> result;
    for (size_t i = 0; i < counts.size(); ++i)
      if (counts[i] > 0) result.insert(int(i));
    return result;
  }
};

/// A light that notes at which levels it is asked.
class NotingLight final : public PlacedLight {
 public:
  NotingLight(std::shared_ptr<const Light> light, Levels& levels)
      : light_(std::move(light)), levels_(levels) {
    traits_ = light_->traits();
    traits_.shadow_samples = 1;
    traits_.ball.reset();
  }

  float expected_irradiance(const LightQuery& query) const override {
    return light_->expected_irradiance(query);
  }
  LightSample sample_toward(const LightQuery& query, const Vec2f& u) const override {
    ++levels_.sampled.at(size_t(query.level));
    return light_->sample_toward(query, u);
  }
  float pdf_toward(const LightQuery& query, const LightTarget& target) const override {
    ++levels_.asked.at(size_t(query.level));
    return light_->pdf_toward(query, target);
  }
  Spectrum emitted(const SurfacePoint& point, const Vec3f& direction,
                   const Wavelengths& wavelengths) const override {
    return light_->emitted(point, direction, wavelengths);
  }
  EmissionSample sample_emission(const Vec2f& u, const Vec2f& v,
                                 const Wavelengths& wavelengths) const override {
    return light_->sample_emission(u, v, wavelengths);
  }
  float emission_pdf_position(const SurfacePoint& point) const override {
    return light_->emission_pdf_position(point);
  }
  float emission_pdf_direction(const SurfacePoint& point, const Vec3f& direction) const override {
    return light_->emission_pdf_direction(point, direction);
  }
  EmissionSample sample_origin(const Vec2f& u) const override {
    return light_->placed().sample_origin(u);
  }

 private:
  std::shared_ptr<const Light> light_;
  Levels& levels_;
};

/// Renders one pass of a scene whose first light notes what it is asked.
void render_noting(const std::string& inside, const std::string& type,
                   const std::string& parameters, Levels& levels) {
  const Description description = description_of(inside);
  Scene::Parts parts = SceneBuilder(int64_t(1) << 30).build(*description.scene);
  parts.lights[0] = std::make_shared<const NotingLight>(parts.lights[0], levels);
  const Scene scene(std::move(parts));
  std::vector<std::string> warnings;
  const auto integrator = make_integrator(
      description_of("<integrator type=\"" + type + "\">" + parameters + "</integrator>"), scene,
      warnings);
  SessionSettings settings;
  settings.passes = 1;
  settings.samples_per_pixel = 16;
  Session(scene, *integrator, settings).run();
}

/// A room with a glossy floor; `bar` is the lamp.
std::string levels_room(const std::string& bar, int size = 6) {
  return camera("0, -0.9, 0.5", "0, 1, -0.7", 60, size) +
         flat("rectangle", scale("1, 1, 1") + translate("0, 0, -1"), phong(0.3, 0.5, 20)) +
         R"(<shape type="cube"><transform name="to_world"><scale value="1.01"/></transform>)" +
         "<bsdf type=\"twosided\">" + diffuse("0.5") + "</bsdf>" + "</shape>" + bar;
}
const std::string strip_transform =
    scale("0.7, 0.3, 1") + rotate("1, 0, 0", 180) + translate("0.1, 0.2, -0.5");
const std::string plain_bar = flat("rectangle", strip_transform, area_light("10"));
/// The same in many triangles.
std::string fine_bar(const StripMesh& mesh) {
  return mesh.shape(strip_transform, area_light("10"));
}

using Set = std::set<int>;

TEST(LightLevels, OfPathAreItsEvents) {
  Levels levels;
  render_noting(levels_room(plain_bar), "path", set("max_depth", 4), levels);
  EXPECT_EQ(Levels::seen(levels.sampled), (Set{0, 1, 2}));
  EXPECT_EQ(Levels::seen(levels.asked), (Set{0, 1, 2}));
}

/// A mirror counts: what is seen by it is one level deeper.
TEST(LightLevels, MirrorsCount) {
  Levels levels;
  render_noting(
      camera("0, -0.9, 0.5", "0, 1, 0.5", 20, 4) +
          flat("rectangle", rotate("1, 0, 0", 90) + translate("0, 1, 0"), mirror()) +
          flat("rectangle", rotate("1, 0, 0", -90) + translate("0, -1, 0"), diffuse("0.5")) +
          plain_bar,
      "raytracing", "", levels);
  EXPECT_EQ(Levels::seen(levels.sampled), (Set{1}));
}

TEST(LightLevels, OfPhotonMapsReachGatherRays) {
  const std::string few = set("global_photons", 2000) + set("caustic_photons", 0);
  for (const bool cache : {false, true}) {
    Levels levels;
    render_noting(levels_room(plain_bar), "photonmap", few + set("irradiance_cache", cache),
                  levels);
    const Set sampled = Levels::seen(levels.sampled);
    EXPECT_TRUE(sampled.contains(0) && sampled.contains(1)) << cache;
    EXPECT_GT(levels.sampled[1], levels.sampled[0]) << cache;
  }
}

/// In a haze as well.
TEST(LightLevels, OfMediaAreTheEvents) {
  Levels levels;
  std::string inside = levels_room(plain_bar);
  inside.insert(inside.find("<film"), medium("", "2", "0.9", 0));
  render_noting(inside, "path", set("max_depth", 4), levels);
  EXPECT_EQ(Levels::seen(levels.sampled), (Set{0, 1, 2}));
}

/// Sampling at a level and weighing by the density at that level go together: path tracing finds
/// the light of a lamp that is sampled more coarsely at deeper levels as that of one that is not.
TEST(LightLevels, ChangeNoMean) {
  const StripMesh strip(40);
  const TestScene mesh(levels_room(fine_bar(strip))), plain(levels_room(plain_bar));
  const auto mean = [](const TestScene& scene, const char* integrator, const std::string& more,
                       double samples, uint64_t seed) {
    return render(scene, integrator, set("max_depth", 4) + more, {samples, seed}).mean({""});
  };
  expect_equal_means("bar of triangles over one rectangle", mean(mesh, "path", "", 1000, 1),
                     mean(plain, "path", "", 1000, 2));
}

}  // namespace
}  // namespace kaustik
