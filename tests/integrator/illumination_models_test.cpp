// The classical illumination models, alone and as models of single surfaces.

#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

std::string integrator(const std::string& type, const std::string& parameters = "") {
  return "<integrator type=\"" + type + "\">" + parameters + "</integrator>";
}
double one_pixel(const TestScene& scene, const std::string& type, const std::string& parameters) {
  return render(scene, type, parameters, {1, 1, 1}).mean({""}).mean();
}

// A floor of reflectance 0.6, a point light of 5 W/sr 2 m above it: ρ/π · I/h², seen from above.
const std::string looking_down = camera("0, 0, 3", "0, 0, 0", 0.02, 1, "0, 1, 0");
const std::string lit_floor =
    looking_down + flat("rectangle", scale("4, 4, 1"), diffuse("0.6")) + point_light("0, 0, 2", 5);
const std::string screen =
    flat("rectangle", scale("0.1, 0.1, 1") + translate("0.05, 0, 1"), diffuse("0.5"));
constexpr double direct_on_floor = 0.6 / M_PI * 5 / 4;

TEST(LocalPhong, DirectAndAmbientLight) {
  const TestScene scene(lit_floor);
  EXPECT_NEAR(one_pixel(scene, "localphong", ""), direct_on_floor, 1e-5);
  EXPECT_NEAR(one_pixel(scene, "localphong", set("ambient", 0.25)), direct_on_floor + 0.6 * 0.25,
              1e-5);
}
/// The camera looks under a screen that keeps the lamp's light off.
TEST(LocalPhong, WithAndWithoutShadows) {
  const TestScene scene(camera("0, -2, 0.05", "0, 0, 0", 0.02, 1) +
                        flat("rectangle", scale("4, 4, 1"), diffuse("0.6")) +
                        point_light("0, 0, 2", 5) + screen);
  EXPECT_NEAR(one_pixel(scene, "localphong", set("ambient", 0.25)), 0.6 * 0.25, 1e-5);
  EXPECT_NEAR(one_pixel(scene, "localphong", set("shadows", false)), direct_on_floor, 1e-4);
}
/// Constant light falls off as the emitter says, in the classical models alone.
TEST(LocalPhong, ClassicalAttenuation) {
  const TestScene scene(looking_down + flat("rectangle", scale("4, 4, 1"), diffuse("0.6")) +
                        R"(<emitter type="point"><point name="position" value="0, 0, 2"/>
         <rgb name="intensity" value="5"/><vector name="attenuation" value="1, 0.5, 0"/></emitter>)");
  const double attenuated = 0.6 / M_PI * 5 / (1 + 0.5 * 2);
  EXPECT_NEAR(one_pixel(scene, "localphong", ""), attenuated, 1e-5);
  EXPECT_NEAR(one_pixel(scene, "raytracing", ""), attenuated, 1e-5);
  EXPECT_NEAR(one_pixel(scene, "path", ""), direct_on_floor, 1e-5);
}
/// What is the same from everywhere is reflected by the albedo: as a path tracer finds on a convex
/// body in an even environment.
TEST(LocalPhong, AmbientLightIsAnEvenEnvironment) {
  const std::string ball =
      camera("0, -4, 0", "0, 0, 0", 20, 8) + sphere("0, 0, 0", 1, phong(0.3, 0.4, 30));
  const TestScene dark(ball), bright(ball + constant_light(2));
  const auto seen = [](int x, int y) { return x >= 2 && x < 6 && y >= 2 && y < 6 ? 1.0 : 0.0; };
  expect_near_means("ambient light on Phong",
                    render(dark, "localphong", set("ambient", 2.0), {64, 1}).mean({""}, seen),
                    render(bright, "path", "", {1024, 2}).mean({""}, seen), 0.02);
}
TEST(LocalPhong, DirectLightIsThatOfPath) {
  const TestScene scene(
      camera("0, -2.2, 1.3", "0, 0.2, 0.35", 48, 16) +
      flat("rectangle", scale("2, 2, 1"), phong(0.3, 0.6, 20)) +
      sphere("0, 0, 0.4", 0.4, diffuse("0.5, 0.4, 0.3")) +
      flat("rectangle", scale("0.3, 0.15, 1") + rotate("1, 0, 0", 180) + translate("0, 0.1, 1.4"),
           diffuse("0, 0, 0") + area_light("10, 9, 8")) +
      point_light("1, -1, 1", 2));
  expect_equal_means("localphong direct",
                     render(scene, "localphong", set("light_samples", 4), {64, 1}).mean({"direct"}),
                     render(scene, "path", "", {128, 2}).mean({"direct"}));
}

/// A slab of reflectance R = 1/4 at each side before a wall that shines with 1: after two events
/// (1 − R)² has come through, after four R² times as much more, after all (1 − R)/(1 + R).
class Slab : public testing::Test {
 protected:
  Slab()
      : scene_(camera("0, 0, 4", "0, 0, 0", 0.02, 1, "0, 1, 0") + "<shape type=\"cube\">" +
               glass(3) + "</shape>" +
               flat("rectangle", scale("9, 9, 1") + translate("0, 0, -3"),
                    diffuse("0, 0, 0") + area_light("1, 1, 1"))) {}
  double through(int max_depth, int rr_depth) const {
    return one_pixel(scene_, "raytracing", set("max_depth", max_depth) + set("rr_depth", rr_depth));
  }
  TestScene scene_;
};
TEST_F(Slab, FollowsBothWaysToTheDepthLimit) {
  EXPECT_EQ(through(2, 16), 0);
  EXPECT_NEAR(through(3, 16), 0.5625, 1e-5);
  EXPECT_NEAR(through(4, 16), 0.5625, 1e-5);
  EXPECT_NEAR(through(5, 16), 0.5625 * (1 + 1 / 16.0), 1e-5);
  EXPECT_NEAR(through(12, 16), 0.6, 1e-5);
}
TEST_F(Slab, ChoosesOneWayBehindTheFirstEvents) {
  for (const int rr_depth : {0, 2})
    expect_mean(fmt::format("slab, rr_depth {}", rr_depth),
                render(scene_, "raytracing", set("rr_depth", rr_depth), {16384, 1}).mean({""}),
                0.6);
}
TEST(RayTracing, LosslessGlassIsInvisibleInAnEvenEnvironment) {
  const TestScene scene(camera("0, -3, 0", "0, 0, 0", 30, 8) + sphere("0, 0, 0", 0.6, glass()) +
                        sphere("0.4, 1.5, 0", 0.5, glass(1.8)) + constant_light(1));
  const Passes passes = render(scene, "raytracing", "", {256, 1});
  expect_mean("glass in an even environment", passes.mean({""}), 1);
}

/// Diffuse surfaces that do not see one another, mirror and glass, a point light: up to four
/// segments path tracing finds just what ray tracing does.
TEST(RayTracing, FindsWhatPathTracingDoes) {
  const TestScene scene(camera("0, -2.2, 1.3", "0, 0.2, 0.35", 48, 16) +
                        flat("rectangle", scale("2, 2, 1"), diffuse("0.5, 0.5, 0.5")) +
                        sphere("-0.45, 0.3, 0.401", 0.4, mirror()) +
                        sphere("0.45, -0.05, 0.401", 0.4, glass()) +
                        point_light("0.3, -0.5, 2", 5));
  const std::string depth = set("max_depth", 4);
  const Passes path = render(scene, "path", depth, {512, 2});
  const Passes found = render(scene, "raytracing", depth, {64, 1});
  expect_equal_means("raytracing direct", found.mean({"direct"}), path.mean({"direct"}));
  expect_equal_means("raytracing specular", found.mean({"specular"}), path.mean({"specular"}));
  EXPECT_EQ(found.mean({"indirect"}).mean(), 0);
}

/// A corner of two walls under a lamp: the left one fills the left half of the picture, the right
/// one the other.
std::string corner(const std::string& in_right_wall) {
  const std::string turned = rotate("1, 0, 0", 90);
  return camera("0, -2, 0", "0, 0, 0", 40, 8) +
         flat("rectangle", turned + translate("-1, 0, 0") + rotate("0, 0, 1", 45),
              diffuse("0.7, 0.5, 0.5")) +
         flat("rectangle", turned + translate("1, 0, 0") + rotate("0, 0, 1", -45),
              diffuse("0.5, 0.5, 0.7") + in_right_wall) +
         flat("rectangle",
              scale("0.3, 0.3, 1") + rotate("1, 0, 0", 180) + translate("0, -0.9, 1.5"),
              diffuse("0, 0, 0") + area_light("10, 9, 8"));
}
/// The picture of one pass.
Image picture(const TestScene& scene, const std::string& type, const std::string& parameters) {
  return render(scene, type, parameters, {4, 1, 1}).images()[0];
}
/// The left half is `left`'s, the right half `right`'s, to the bit.
void expect_halves(const Image& image, const Image& left, const Image& right) {
  int equal = 0;
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) {
      EXPECT_EQ(image.at(x, y, 1), (x < 4 ? left : right).at(x, y, 1)) << x << ", " << y;
      equal += left.at(x, y, 1) == right.at(x, y, 1);
    }
  EXPECT_LT(equal, 8) << "the models must differ for this to show anything";
}

const std::string few_photons = set("global_photons", 2000);

TEST(SurfaceModels, OneSurfaceHasItsOwnModelAndNothingElseChanges) {
  const TestScene plain(corner("")), mixed(corner(integrator("localphong")));
  for (const char* of_scene : {"path", "photonmap", "raytracing"}) {
    SCOPED_TRACE(of_scene);
    const std::string parameters = of_scene == std::string("photonmap")    ? few_photons
                                   : of_scene == std::string("raytracing") ? set("ambient", 0.5)
                                                                           : std::string();
    expect_halves(picture(mixed, of_scene, parameters), picture(plain, of_scene, parameters),
                  picture(plain, "localphong", ""));
  }
}
TEST(SurfaceModels, AnyMethodFromTheCameraCanBeAModel) {
  const TestScene plain(corner(""));
  for (const char* own : {"path", "photonmap", "raytracing"}) {
    SCOPED_TRACE(own);
    const std::string parameters = own == std::string("photonmap")    ? few_photons
                                   : own == std::string("raytracing") ? set("ambient", 0.5)
                                                                      : std::string();
    const TestScene mixed(corner(integrator(own, parameters)));
    expect_halves(picture(mixed, "localphong", ""), picture(plain, "localphong", ""),
                  picture(plain, own, parameters));
  }
}
/// Mirrors show surfaces as their own models say.
TEST(SurfaceModels, SeenInAMirror) {
  const auto scene = [](const std::string& own) {
    return TestScene(
        camera("0, 0, 2", "0, 0, 0", 0.02, 1, "0, 1, 0") +
        flat("rectangle", scale("2, 2, 1"), mirror()) +
        flat("rectangle", rotate("1, 0, 0", 180) + translate("0, 0, 3"), diffuse("0.6") + own) +
        point_light("0, 0, 1", 5));
  };
  const double direct = 0.6 / M_PI * 5 / 4;
  EXPECT_NEAR(one_pixel(scene(integrator("localphong", set("ambient", 0.5))), "path", ""),
              direct + 0.3, 1e-4);
  EXPECT_NEAR(one_pixel(scene(""), "raytracing", ""), direct, 1e-4);
}

/// What a scene with `shape_parts` in its sphere and `at_top` says when its integrator is made.
std::string refusal(const std::string& shape_parts, const std::string& at_top = "") {
  const Description description =
      description_of(camera("0, -3, 0", "0, 0, 0", 40, 4) + "\n" + at_top + "\n" +
                     sphere("0, 0, 0", 1, "\n" + shape_parts + "\n"));
  try {
    const auto scene = build_scene(description);
    std::vector<std::string> warnings;
    make_integrator(description, *scene, warnings);
    return warnings.empty() ? "" : warnings.front();
  } catch (const Error& error) {
    return error.what();
  }
}
void expect_said(const std::string& text, std::initializer_list<const char*> parts) {
  for (const char* part : parts)
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

TEST(SurfaceModels, Mistakes) {
  expect_said(refusal(integrator("localfong")), {"unknown integrator type", "localphong", ":9:"});
  expect_said(refusal(integrator("localphong", set("ambeint", 1.0))),
              {"ambeint", "ambient", ":9:"});
  expect_said(refusal(integrator("lighttracer")), {"cannot belong to a single shape", "path"});
  expect_said(refusal(integrator("photonmap", set("samples_per_pass", 4))),
              {"samples_per_pass", "whole picture"});
  expect_said(refusal(integrator("path") + integrator("path")), {"second integrator"});
  expect_said(refusal(integrator("path"), integrator("lighttracer")),
              {"no effect with integrator 'lighttracer'"});
}
TEST(SurfaceModels, AreReferredToById) {
  const std::string shared = "<integrator type=\"localphong\" id=\"plain\"/>";
  EXPECT_EQ(refusal("<ref id=\"plain\"/>", shared + integrator("path")), "");
  EXPECT_EQ(refusal("<ref id=\"plain\"/>", shared), "");
  expect_said(refusal("<ref id=\"plain\"/>", shared + integrator("path") + integrator("path")),
              {"second integrator"});
}

}  // namespace
}  // namespace kaustik
