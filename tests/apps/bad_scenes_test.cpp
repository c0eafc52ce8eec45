// Scenes that hold nothing to see, or hardly anything for an integrator to work with: every
// integrator makes the right picture of them, or says what to do.

#include <cmath>
#include <numbers>
#include <regex>

#include "kaustik/image/image_io.h"
#include "tests/apps/program.h"
#include "tests/support/scene_text.h"

namespace kaustik::test {
namespace {

#ifdef KAUSTIK_SLOW_BUILD
constexpr int size = 6;
#else
constexpr int size = 16;
#endif

struct BadScene {
  std::string name;
  std::string inside;  ///< of <scene>
  double mean = 0;     ///< of the picture; 0: all of it is black
  /// Of what reaches the camera from lamps or matt surfaces without a mirror or glass between: all
  /// that light paths can be splatted to.
  double mean_of_splats = 0;
  std::string warning;  ///< that is due
};

std::string view() { return camera("0, -4, 2", "0, 0, 0.3", 45, size); }
std::string floor() { return flat("rectangle", scale("3"), diffuse("0.5")); }
std::string facing_down(const std::string& at) { return rotate("1, 0, 0", 180) + translate(at); }
std::string gray_mirror() {
  return R"(<bsdf type="conductor"><rgb name="specular_reflectance" value="0.5"/></bsdf>)";
}
/// A cube that is matt on both sides.
std::string box(const std::string& transform, const std::string& reflectance) {
  return flat("cube", transform, R"(<bsdf type="twosided">)" + diffuse(reflectance) + "</bsdf>");
}
std::string one_triangle(const std::string& inside) {
  return R"(<shape type="obj"><string name="filename" value="triangle.obj"/>)" + inside +
         "</shape>";
}
/// Sees nothing but the triangle.
std::string triangle_view() { return camera("0, -0.2, 1", "0, -0.2, 0", 20, size, "0, 1, 0"); }

/// In a cube from −1 to 1 of mirrors that reflect a half, with a black lamp of radiance 1 below its
/// ceiling, the mean of the picture and of the lamp alone.
struct MirrorRoom {
  static constexpr double lamp_z = 0.9, lamp_half = 0.5, fov = 60;
  static inline const Vec3d eye{0, -0.9, 0}, target{0, 0, 0.3};
  double mean = 0, mean_of_lamp = 0;

  MirrorRoom() {
    constexpr int rays = 400;  // along a side
    const Vec3d forward = (target - eye).normalized(), right(1, 0, 0), up = right.cross(forward);
    const double half = std::tan(fov / 2 * std::numbers::pi / 180);
    for (int y = 0; y < rays; ++y)
      for (int x = 0; x < rays; ++x) {
        const auto across = [&](int i) { return half * ((2 * i + 1.0) / rays - 1); };
        const int mirrors = mirrors_before_lamp(forward + right * across(x) + up * across(y));
        if (mirrors < 0) continue;
        mean += std::pow(0.5, mirrors) / (rays * rays);
        if (mirrors == 0) mean_of_lamp += 1.0 / (rays * rays);
      }
  }

  /// −1: the back of the lamp, or so many that it makes no difference.
  static int mirrors_before_lamp(Vec3d direction) {
    Vec3d at = eye;
    for (int mirrors = 0; mirrors < 30; ++mirrors) {
      int wall = 0;
      double way = INFINITY;
      for (int axis = 0; axis < 3; ++axis) {
        const double there = (std::copysign(1, direction[axis]) - at[axis]) / direction[axis];
        if (there < way) way = there, wall = axis;
      }
      const double to_lamp = (lamp_z - at.z) / direction.z;
      const Vec3d met = at + direction * to_lamp;
      const bool on_lamp = std::fabs(met.x) < lamp_half && std::fabs(met.y) < lamp_half;
      if (to_lamp > 0 && to_lamp < way && on_lamp) return direction.z > 0 ? mirrors : -1;
      at += direction * way;
      direction[wall] = -direction[wall];
    }
    return -1;
  }
};

std::vector<BadScene> without_light() {
  const std::string lamp =
      flat("rectangle", scale("0.5") + facing_down("0, 0, 1.9"), area_light("0"));
  const std::string bright_lamp =
      flat("rectangle", scale("0.5") + facing_down("0, 0, 1.9"), diffuse("0") + area_light("1"));
  return {
      {"no_light", view() + floor(), 0, 0,
       "the scene has no light: the picture will be black; add an emitter"},
      {"lights_without_power",
       view() + floor() + lamp + point_light("0, 0, 2", 0) + directional_light("0, 0, -1", 0) +
           constant_light(0),
       0, 0, "no light of the scene has power"},
      {"all_black",
       view() + flat("rectangle", scale("3"), diffuse("0")) +
           sphere("0, 0, 0.5", 0.5, diffuse("0")) + bright_lamp,
       0, 0, ""},
      {"lamp_in_a_black_box",
       view() + floor() + box(scale("0.5") + translate("0, 0, 0.6"), "0") +
           flat("rectangle", scale("0.2") + facing_down("0, 0, 0.9"), area_light("1000")),
       0, 0, ""},
      {"lamp_in_a_white_box",
       view() + floor() + box(scale("0.5") + translate("0, 0, 1.5"), "0.8") +
           point_light("0, 0, 1.5", 1000),
       0, 0, ""},
  };
}

std::vector<BadScene> with_light() {
  const MirrorRoom room;
  return {
      // 1 + 1/2 + 1/4 + …
      {"glowing_mirror_ball",
       camera("0.2, 0.1, 0", "0, 0, 1", 60, size, "0, 1, 0") +
           sphere("0, 0, 0", 1, gray_mirror() + area_light("1"), true),
       2, 1, ""},
      // Neighbouring floats are 6 cm apart there.
      {"glowing_mirror_ball_far_away",
       camera("1000002, 1000001, 1000000", "1000000, 1000000, 1000010", 60, size, "0, 1, 0") +
           sphere("1000000, 1000000, 1000000", 10, gray_mirror() + area_light("1"), true),
       2, 1, "move shapes, lights and camera to the origin"},
      {"mirror_room",
       camera("0, -0.9, 0", "0, 0, 0.3", 60, size) +
           flat("cube", "", gray_mirror() + R"(<boolean name="flip_normals" value="true"/>)") +
           flat("rectangle", scale("0.5") + facing_down("0, 0, 0.9"),
                diffuse("0") + area_light("1")),
       room.mean, room.mean_of_lamp, ""},
      // Radiance over the square of the index is kept along rays.
      {"glass_in_a_glowing_ball",
       camera("0, -4, 0", "0, 0, 0", 20, size) + sphere("0, 0, 0", 1, glass()) +
           sphere("0, 0, 0", 10, diffuse("0") + area_light("1"), true),
       1, 0, ""},
      {"glass_under_a_sky",
       camera("0, -4, 0", "0, 0, 0", 20, size) + sphere("0, 0, 0", 1, glass()) + constant_light(1),
       1, 0, ""},
      {"triangle_that_glows", triangle_view() + one_triangle(diffuse("0.5") + area_light("1")), 1,
       1, ""},
      {"triangle_that_is_lit",
       triangle_view() + one_triangle(diffuse("0.5")) +
           directional_light("0, 0, -1", std::numbers::pi),
       0.5, 0.5, ""},
  };
}

const std::vector<BadScene>& bad_scenes() {
  static const std::vector<BadScene> scenes = [] {
    std::vector<BadScene> all = without_light();
    for (BadScene& scene : with_light()) all.push_back(std::move(scene));
    return all;
  }();
  return scenes;
}

const std::vector<std::string> integrators = {"auto", "vcm",         "bdpt",     "ppm",
                                              "path", "lighttracer", "photonmap"};

struct Case {
  BadScene scene;
  std::string integrator;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const BadScene& scene : bad_scenes())
    for (const std::string& integrator : integrators) all.push_back({scene, integrator});
  return all;
}

struct Mean {
  double value = 0;
  /// Of 95 %, by Student's t of the 16 passes, as the program tells it.
  double half_width = 0;
};

/// At a level of 1e-4: Student's t of 15 degrees of freedom is 5.24 there, 2.13 at 5 %.
bool agrees(const Mean& mean, double truth) {
  return std::fabs(mean.value - truth) <= std::max(2.46 * mean.half_width, 1e-5 * truth);
}

class BadScenes : public ProgramTest, public testing::WithParamInterface<Case> {
 protected:
  BadScenes() { write("triangle.obj", "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n"); }

  RunResult render(const Case& c) const {
    write("scene.xml", "<scene version=\"3.0.0\">" + c.scene.inside + "</scene>");
    std::vector<std::string> arguments = {
        "render",  "scene.xml", "--integrator", c.integrator, "--threads",
        "1",       "--passes",  "16",           "--spp",      "32",
        "--float", "-o",        "a.exr",        "--seed",     "3"};
    if (c.integrator == "photonmap")
      for (const char* photons :
           {"global_photons=1000", "caustic_photons=1000", "cache_samples=16"})
        arguments.insert(arguments.end(), {"--set", std::string("integrator.") + photons});
    return run_well(arguments);
  }
  Mean mean_of(const RunResult& result) const {
    Mean mean;
    const Image image = read_image(path("a.exr"));
    for (const char* name : {"R", "G", "B"})
      for (const float value : image.channel(image.find_channel(name)))
        mean.value += double(value) / (3.0 * double(image.pixel_count()));
    std::smatch told;
    if (std::regex_search(result.err, told, std::regex("mean of the picture: ±([0-9.e+-]+) %")))
      mean.half_width = mean.value * std::stod(told[1]) / 100;
    return mean;
  }
  /// Every layer is finite, and no light is negative.
  void expect_valid_pixels() const {
    const Image image = read_image(path("a.exr"));
    for (int c = 0; c < image.channel_count(); ++c)
      for (const float value : image.channel(c))
        ASSERT_TRUE(std::isfinite(value)) << image.channel_names()[size_t(c)];
    for (const char* name : {"R", "G", "B"})
      for (const float value : image.channel(image.find_channel(name))) ASSERT_GE(value, 0);
  }
};

TEST_P(BadScenes, GiveTheRightPicture) {
  const Case& c = GetParam();
  const RunResult result = render(c);
  expect_valid_pixels();
  EXPECT_FALSE(contains(result.err, "not finite")) << result.err;
  EXPECT_TRUE(contains(result.err, c.scene.warning)) << result.err;
  for (const char* other : {"no light", "move shapes"})
    EXPECT_TRUE(contains(c.scene.warning, other) || !contains(result.err, other)) << result.err;
  const bool splats = c.integrator == "lighttracer";
  const double truth = splats ? c.scene.mean_of_splats : c.scene.mean;
  const Mean mean = mean_of(result);
  if (truth == 0) {
    EXPECT_EQ(mean.value, 0);
    return;
  }
  EXPECT_TRUE(agrees(mean, truth)) << mean.value << " ± " << mean.half_width << " of " << truth;
#ifndef KAUSTIK_SLOW_BUILD
  const double planted_error = splats ? 1.25 : 1.05;
  EXPECT_FALSE(agrees(mean, planted_error * truth)) << mean.value << " ± " << mean.half_width;
#endif
}

INSTANTIATE_TEST_SUITE_P(, BadScenes, testing::ValuesIn(cases()), [](const auto& test) {
  return test.param.scene.name + "_by_" + test.param.integrator;
});

}  // namespace
}  // namespace kaustik::test
