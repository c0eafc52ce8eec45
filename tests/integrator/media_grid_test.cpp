// Media whose density is a grid, against closed forms, quadrature, and the methods against one
// another.

#include <fstream>

#include "kaustik/image/metrics.h"
#include "tests/integrator/media_scenes.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/vol_file.h"

namespace kaustik {
namespace {

using namespace test;

const std::vector<float> corner_values = {0.2f, 1.5f, 0.7f, 0.1f, 1.0f, 0.4f, 2.0f, 1.2f};

/// Scenes with volumes in files of their own.
class GridMedia : public testing::Test {
 protected:
  /// A volume of that name over the cube from −half to half.
  std::string volume(const std::string& name, const std::string& bytes, double half) {
    const std::string path = folder_.path(fmt::format("{}.vol", files_++));
    std::ofstream(path, std::ios::binary) << bytes;
    return fmt::format(
        R"(<volume name="{}" type="gridvolume"><string name="filename" value="{}"/>
        <transform name="to_world"><translate value="-0.5, -0.5, -0.5"/><scale value="{}"/>
        </transform></volume>)",
        name, path, 2 * half);
  }
  static std::string medium_of(const std::string& volumes, double albedo = 0.8, double g = 0) {
    return fmt::format(
        R"(<medium name="interior" type="heterogeneous">{}<float name="albedo" value="{}"/>
        <phase type="hg"><float name="g" value="{}"/></phase></medium>)",
        volumes, albedo, g);
  }
  /// Eight values, one in each corner.
  std::string corners(double half) {
    return volume("sigma_t", vol_file({2, 2, 2}, corner_values), half);
  }

 private:
  TemporaryFolder folder_;
  int files_ = 0;
};

/// Density of those corners in the cube from −1 to 1.
double corner_density(const Vec3d& p) {
  double sum = 0;
  for (size_t i = 0; i < 8; ++i) {
    double weight = 1;
    for (int axis = 0; axis < 3; ++axis) {
      // From one middle of a cell to the other.
      const double share = std::clamp(p[axis] + 0.5, 0.0, 1.0);
      weight *= i >> axis & 1 ? share : 1 - share;
    }
    sum += weight * double(corner_values[i]);
  }
  return sum;
}
double corner_depth(const Vec3d& from, const Vec3d& to, int steps = 200) {
  return simpson(0, (to - from).length(), steps,
                 [&](double s) { return corner_density(from + (to - from).normalized() * s); });
}

/// The sun's, too, by what lies behind the places where its rays begin.
TEST_F(GridMedia, DimTheSun) {
  const std::string density = volume("sigma_t", vol_file({1, 1, 1}, {0.1f}), 5);
  const auto seen_by = [&](double fov) {
    return TestScene(camera_in("<medium type=\"heterogeneous\">" + density +
                                   "<float name=\"albedo\" value=\"0\"/></medium>",
                               camera("0, 0, 4", "0, 0, -4", fov, 4, "0, 1, 0")) +
                     flat("rectangle", scale("4") + translate("0, 0, -4"), diffuse("0.5")) +
                     R"(<emitter type="directional"><vector name="direction" value="0, 0, -1"/>
                     <rgb name="irradiance" value="2, 2, 2"/></emitter>)");
  };
  const double expected = 0.5 / std::numbers::pi * 2 * std::exp(-0.1 * 9) * std::exp(-0.1 * 8);
  EXPECT_NEAR(render(seen_by(0.1), "photonmap", "", {1}).mean({"direct"}).mean() / expected, 1,
              1e-4);
  const TestScene wide = seen_by(40);
  const RunningStatistics by_path = render(wide, "path", "", {400}).mean({"direct"});
  for (const std::string type : {"lighttracer", "bdpt"})
    expect_near_means(type + ", the sun through a grid",
                      Comparison(render(wide, type, "", {400}).mean({"direct"}), by_path), 0.02,
                      0.01);
}

/// Light that crosses it without being scattered.
TEST_F(GridMedia, LetTheLightOfALampThrough) {
  const TestScene scene(camera("0.3, 0.2, 6", "0.3, 0.2, 0", 0.05, 2, "0, 1, 0") +
                        flat("cube", scale("1"), null_bsdf + medium_of(corners(1), 0)) +
                        flat("rectangle", scale("0.3") + translate("0.3, 0.2, -3"),
                             diffuse("0, 0, 0") + area_light("2, 2, 2")));
  const double expected = 2 * std::exp(-corner_depth({0.3, 0.2, 1}, {0.3, 0.2, -1}));
  EXPECT_NEAR(render(scene, "photonmap", "", {8}).mean({"emission"}).mean() / expected, 1, 1e-3);
  expect_mean("path, a lamp behind a grid", render(scene, "path", "", {4000}).mean({"emission"}),
              expected);
}

/// Light of a lamp within it that is scattered once into a ray.
TEST_F(GridMedia, ScatterOnceAsQuadratureSays) {
  const Vec3d lamp(0.7, 0.3, -0.2);
  const TestScene scene(camera("0.1, -0.2, 3", "0.1, -0.2, 0", 0.05, 4, "0, 1, 0") +
                        flat("cube", scale("1"), null_bsdf + medium_of(corners(1))) +
                        point_light("0.7, 0.3, -0.2", 1));
  const double expected = simpson(-1, 1, 400, [&](double z) {
    const Vec3d p(0.1, -0.2, z);
    const double depth = corner_depth({0.1, -0.2, 1}, p) + corner_depth(p, lamp);
    return 0.8 * corner_density(p) * std::exp(-depth) /
           (4 * std::numbers::pi * (lamp - p).length2());
  });
  for (const std::string type : {"path", "bdpt"})
    expect_equal_means(
        fmt::format("{}, scattered once in a grid", type),
        Comparison(render(scene, type, set("max_depth", 2), {type == "path" ? 1200.0 : 400.0})
                       .mean({"volume"}),
                   expected),
        0.005);
}

/// A grid of one value is a homogeneous medium, whose closed form is known, for every method.
class EveryMethod : public GridMedia, public testing::WithParamInterface<const char*> {};

TEST_P(EveryMethod, SeesAConstantGridAsHomogeneous) {
  std::vector<float> constant;
  for (int i = 0; i < 8; ++i)
    for (const double sigma : ball_sigma) constant.push_back(float(sigma));
  const std::string grid = volume("sigma_t", vol_file({2, 2, 2}, constant, {.channels = 3}), 1);
  const TestScene scene(camera("0, 0, 4", "0, 0, 0", ball_fov, 8, "0, 1, 0") +
                        sphere("0, 0, 0", 1, null_bsdf + medium_of(grid, ball_albedo)) +
                        point_light("0, 0, 0", 1));
  const std::string type = GetParam();
  const bool merges = type != "path" && type != "lighttracer" && type != "bdpt";
  const std::string parameters =
      type == "photonmap"
          ? set("volume_photons", 20'000) + set("volume_neighbors", 10) + set("max_light_level", 0)
          : set("max_depth", 2);
  const double samples = type == "path"          ? 500
                         : type == "lighttracer" ? 250
                         : type == "photonmap"   ? 16
                                                 : 150;
  const Passes passes = render(scene, type, parameters, {samples});
  for (const int channel : {0, 2}) {
    const Comparison c(passes.mean({"volume"}, beside_the_lamp, channel),
                       lamp_in_ball_beside(ball_sigma[channel], ball_albedo, 0));
    const std::string what = fmt::format("{}, constant grid, {}", type, "RGB"[channel]);
    if (merges)
      expect_near_means(what, c, 0.01, 0.005);
    else
      expect_equal_means(what, c, 0.005);
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, EveryMethod,
                         testing::Values("path", "lighttracer", "bdpt", "vcm", "ppm", "auto",
                                         "photonmap"),
                         [](const auto& tested) { return std::string(tested.param); });

/// A small cloud on a matt floor, half of it empty, with a coloured albedo that varies.
class Cloud : public GridMedia {
 protected:
  std::string scene_text(double share = 1) {
    constexpr int n = 48;  // some regions whose densities have bounds of their own
    std::vector<float> density;
    for (int z = 0; z < n; ++z)
      for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
          const double middle = 0.5 * (n - 1);
          const double r = std::hypot(x - middle, y - middle, z - middle) / (middle + 0.5);
          const double waves = 1 + 0.8 * std::sin(0.33 * x) * std::cos(0.28 * y + 0.18 * z);
          density.push_back(float(share * 4 * std::max(0.0, 0.9 - r) * waves));
        }
    const std::string albedo = volume(
        "albedo", vol_file({2, 1, 1}, {0.9f, 0.6f, 0.3f, 0.4f, 0.9f, 0.9f}, {.channels = 3}), 1);
    const std::string inside = volume("sigma_t", vol_file({n, n, n}, density), 1) + albedo;
    return camera("0, -5, 1.5", "0, 0, 0", 35, 8) +
           flat("rectangle", scale("2") + translate("0, 0, -1.1"), diffuse("0.7, 0.6, 0.5")) +
           flat("cube", scale("1"),
                null_bsdf + "<medium name=\"interior\" type=\"heterogeneous\">" + inside +
                    R"(<phase type="hg"><float name="g" value="0.4"/></phase></medium>)") +
           point_light("1, -1, 2.5", 8);
  }
};

TEST_F(Cloud, PathAndLightTracerAgreeLong) {
  const TestScene scene(scene_text());
  EXPECT_TRUE(scene.scene().warnings().empty());
  const Passes path = render(scene, "path", "", {3500});
  const Passes light = render(scene, "lighttracer", "", {4500});
  for (const std::string component : {"direct", "volume"})
    for (const int channel : {0, 2})
      expect_equal_means(
          fmt::format("cloud, {} {}", component, "RGB"[channel]),
          Comparison(light.mean({component}, {}, channel), path.mean({component}, {}, channel)),
          0.005);
}

TEST_F(Cloud, PathAndBdptAgree) {
  const TestScene scene(scene_text());
  const RunningStatistics path = render(scene, "path", "", {240}).mean({"volume"});
  const RunningStatistics bdpt = render(scene, "bdpt", "", {180}).mean({"volume"});
  expect_near_means("cloud, volume", Comparison(bdpt, path), 0.03, 0.01);
}

TEST_F(Cloud, EveryMethodAgreesLong) {
  const TestScene scene(scene_text());
  const Passes path = render(scene, "path", "", {5000});
  for (const std::string type : {"bdpt", "vcm", "ppm", "auto", "photonmap"}) {
    const Passes found =
        render(scene, type,
               type == "photonmap" ? set("volume_photons", 200'000) + set("volume_neighbors", 20)
                                   : std::string(),
               {type == "photonmap" ? 180.0 : 600.0});
    for (const int channel : {0, 2})
      expect_near_means(
          fmt::format("{}, cloud, volume {}", type, "RGB"[channel]),
          Comparison(found.mean({"volume"}, {}, channel), path.mean({"volume"}, {}, channel)), 0.01,
          0.005);
  }
}

/// The twin: a cloud that is 4 % thinner is told apart.
TEST_F(Cloud, IsToldFromAThinnerOneLong) {
  const Passes path = render(TestScene(scene_text(0.96)), "path", "", {9000});
  const Passes light = render(TestScene(scene_text()), "lighttracer", "", {12000});
  const Comparison c(light.mean({"volume"}), path.mean({"volume"}));
  EXPECT_LT(c.p_value_of_equality(), check_level());
}

/// The same bits for any number of threads.
TEST_F(Cloud, IsTheSameForAnyNumberOfThreads) {
  const TestScene scene(scene_text());
  for (const std::string type : {"path", "vcm", "photonmap"}) {
    const std::string given =
        type == "photonmap" ? set("volume_photons", 2000) + set("global_photons", 2000) : "";
    const Passes one = render(scene, type, given, {4, 1, 2, 1});
    const Passes many = render(scene, type, given, {4, 1, 2, 4});
    for (size_t pass = 0; pass < one.images().size(); ++pass)
      EXPECT_EQ(compare_images(one.images()[pass], many.images()[pass]).mse, 0) << type;
  }
}

}  // namespace
}  // namespace kaustik
