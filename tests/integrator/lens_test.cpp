// A camera with a lens: every method sees the same blur through it.

#include "kaustik/scene/scene_builder.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

/// A thin lens over a pinhole camera that stands at (0, 0, 3), looks along −z and sees sharply what
/// lies in the plane z = 3 − focus.
class ThinLens final : public Camera {
 public:
  ThinLens(std::unique_ptr<Camera> pinhole, float radius, float focus)
      : pinhole_(std::move(pinhole)), radius_(radius), focus_(focus) {
    traits_ = pinhole_->traits();
    traits_.has_lens = true;
  }
  Ray sample_ray(const Vec2f& raster, const Vec2f& u_lens) const override {
    const Ray middle = pinhole_->sample_ray(raster, middle_of_lens());
    const Vec3f sharp = middle.origin + middle.direction * (focus_ / -middle.direction.z);
    const Vec3f lens = lens_point(u_lens);
    return {lens, normalize(sharp - lens), infinity};
  }
  CameraConnection connect(const Vec3f& point, const Vec2f& u_lens) const override {
    CameraConnection c;
    c.lens = lens_point(u_lens);
    const Vec3f from_lens = point - c.lens;
    c.distance = length(from_lens);
    if (!(c.distance > 0) || !(from_lens.z < 0)) return c;
    c.direction = from_lens * (-1 / c.distance);
    const Vec3f sharp = c.lens + from_lens * (focus_ / -from_lens.z);
    const CameraConnection middle = pinhole_->connect(sharp, middle_of_lens());
    c.raster = middle.raster;
    // The same patch of the sharp plane, seen from the middle and from here.
    const float cos_middle = focus_ / middle.distance, cos_lens = c.direction.z;
    c.importance = middle.importance * (cos_middle * cos_middle * cos_middle) /
                   (cos_lens * cos_lens * cos_lens);
    return c;
  }

 private:
  Vec3f lens_point(const Vec2f& u) const {
    const float r = radius_ * std::sqrt(u.x), phi = 2 * pi * u.y;
    return traits_.position + Vec3f(r * std::cos(phi), r * std::sin(phi), 0);
  }

  std::unique_ptr<Camera> pinhole_;
  float radius_, focus_;
};

constexpr int size = 12;

/// A lamp's light on a white card before a dark wall, both out of focus.
Scene seen_through_a_lens(float radius) {
  const Description description = description_of(
      camera("0, 0, 3", "0, 0, 0", 40, size, "0, 1, 0") +
      flat("rectangle", scale("0.4, 2, 1"), diffuse("0.8")) +
      flat("rectangle", scale("4, 4, 1") + translate("0, 0, -1"), diffuse("0.1")) +
      flat("rectangle", scale("0.5, 0.5, 1") + rotate("1, 0, 0", 180) + translate("1.5, 0, 5"),
           area_light("20")));
  Scene::Parts parts = SceneBuilder(int64_t(1) << 30).build(*description.scene);
  if (radius > 0) parts.camera = std::make_unique<ThinLens>(std::move(parts.camera), radius, 2.0f);
  return Scene(std::move(parts));
}

/// Mean of some columns, a value per pass.
RunningStatistics columns(const Scene& scene, const std::string& type,
                          const std::string& parameters, double samples, int from, int to) {
  std::vector<std::string> warnings;
  const auto integrator = make_integrator(
      description_of("<integrator type=\"" + type + "\">" + parameters + "</integrator>"), scene,
      warnings);
  RunningStatistics result;
  for (uint32_t pass = 0; pass < measured_passes; ++pass) {
    SessionSettings settings;
    settings.first_pass = pass;
    settings.passes = 1;
    settings.samples_per_pixel = uint32_t(std::max(1.0, samples * sample_share));
    Session session(scene, *integrator, settings);
    session.run();
    result.add(Passes::mean_of(session.film().image(), {""},
                               [&](int x, int) { return x >= from && x < to ? 1.0 : 0.0; }));
  }
  return result;
}

/// The columns just outside of the card's sharp edge: what is there is blur.
RunningStatistics at_the_edge(const Scene& scene, const std::string& type,
                              const std::string& parameters, double samples) {
  return columns(scene, type, parameters, samples, 8, 10);
}

TEST(Lens, EveryMethodSeesTheSameBlur) {
  const Scene scene = seen_through_a_lens(0.6f);
  const RunningStatistics path = at_the_edge(scene, "path", "", 100);
  expect_equal_means("lighttracer", at_the_edge(scene, "lighttracer", "", 2500), path);
  expect_equal_means("bdpt", at_the_edge(scene, "bdpt", "", 100), path);
  expect_near_means("vcm", at_the_edge(scene, "vcm", set("light_paths", 1.0), 100), path, 0.01);
  expect_near_means("auto", at_the_edge(scene, "auto", "", 100), path, 0.01);
  expect_near_means("photonmap", at_the_edge(scene, "photonmap", set("global_photons", 20'000), 36),
                    path, 0.01);
}

// The twin: without the lens the edge is sharp.
TEST(Lens, APinholeSeesAnotherPicture) {
  const RunningStatistics blurred = at_the_edge(seen_through_a_lens(0.6f), "path", "", 16);
  const RunningStatistics sharp_one = at_the_edge(seen_through_a_lens(0), "path", "", 16);
  EXPECT_GT(blurred.mean(), 1.3 * sharp_one.mean());
}

}  // namespace
}  // namespace kaustik
