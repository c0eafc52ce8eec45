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

/// The columns just outside of the card's sharp edge: what is there is blur.
const std::string whole_camera = camera("0, 0, 3", "0, 0, 0", 40, 12, "0, 1, 0");
std::string camera_at_the_edge() {
  std::string text = whole_camera;
  const std::string film = "<film type=\"hdrfilm\">";
  return text.replace(text.find(film), film.size(),
                      film + set("crop_offset_x", 8) + set("crop_width", 2));
}

const std::string direct_light = R"(<emitter type="spot"><rgb name="intensity" value="10"/>
    <float name="cutoff_angle" value="24"/><float name="beam_width" value="22"/>
    <transform name="to_world"><lookat origin="0.4, 0, 2.9" target="0.4, 0, 0" up="0, 1, 0"/>
    </transform></emitter>)";
/// A lamp behind the camera and walls that send its light on.
const std::string indirect_light =
    flat("rectangle", scale("0.7, 0.7, 1") + rotate("1, 0, 0", 180) + translate("0, 0, 4"),
         area_light("10")) +
    flat("rectangle", scale("3, 3, 1") + rotate("0, 1, 0", 90) + translate("-1.2, 0, 0"),
         diffuse("0.8")) +
    flat("rectangle", scale("3, 3, 1") + rotate("0, 1, 0", -90) + translate("1.2, 0, 0"),
         diffuse("0.8"));

/// A white card before a dark wall, both out of focus.
Scene seen_through_a_lens(float radius, const std::string& view = camera_at_the_edge(),
                          const std::string& light = direct_light) {
  const Description description = description_of(
      view + flat("rectangle", scale("0.4, 2, 1"), diffuse("0.8")) +
      flat("rectangle", scale("4, 4, 1") + translate("0, 0, -1"), diffuse("0.1")) + light);
  Scene::Parts parts = SceneBuilder(int64_t(1) << 30).build(*description.scene);
  if (radius > 0) parts.camera = std::make_unique<ThinLens>(std::move(parts.camera), radius, 2.0f);
  return Scene(std::move(parts));
}

/// Mean of the picture, a value per pass.
std::vector<double> means(const Scene& scene, const std::string& type, double samples,
                          const std::string& parameters = "") {
  std::vector<std::string> warnings;
  const auto integrator = make_integrator(
      description_of("<integrator type=\"" + type + "\">" + parameters + "</integrator>"), scene,
      warnings);
  std::vector<double> result;
  for (uint32_t pass = 0; pass < measured_passes; ++pass) {
    SessionSettings settings;
    settings.first_pass = pass;
    settings.passes = 1;
    settings.samples_per_pixel = uint32_t(std::max(1.0, samples * sample_share));
    Session session(scene, *integrator, settings);
    session.run();
    result.push_back(Passes::mean_of(session.film().image(), {""}));
  }
  return result;
}
RunningStatistics statistics_of(const std::vector<double>& values) {
  RunningStatistics result;
  for (const double value : values) result.add(value);
  return result;
}

// By rays from the lens and by light paths to it.
TEST(Lens, LightPathsReachItAsRaysLeaveIt) {
  const Scene scene = seen_through_a_lens(0.6f);
  expect_equal_means("lighttracer", statistics_of(means(scene, "lighttracer", 6000)),
                     statistics_of(means(scene, "path", 2500)));
}

// What weighs light by both ends knows where on the lens the rays began.
TEST(Lens, MethodsFromBothEndsAgree) {
  const Scene scene = seen_through_a_lens(0.6f, whole_camera, indirect_light);
  const std::vector<double> path = means(scene, "path", 64);
  const auto expect = [&](const std::string& type, const std::string& parameters,
                          double tolerance) {
    expect_near_means(type, Comparison::same_seed(means(scene, type, 64, parameters), path),
                      tolerance, 0.005);
  };
  expect("bdpt", "", 0.005);
  expect("vcm", set("light_paths", 2.0), 0.01);
  expect("photonmap", set("global_photons", 5000), 0.01);
}

// The twin: without the lens the edge is sharp.
TEST(Lens, APinholeSeesAnotherPicture) {
  const RunningStatistics blurred = statistics_of(means(seen_through_a_lens(0.6f), "path", 64));
  const RunningStatistics sharp_one = statistics_of(means(seen_through_a_lens(0), "path", 64));
  EXPECT_GT(blurred.mean(), 1.3 * sharp_one.mean());
}

}  // namespace
}  // namespace kaustik
