// Meters: where their rays go. What they measure: tests/integrator/meters_test.cpp.

#include "kaustik/base/statistics.h"
#include "kaustik/scene/overrides.h"
#include "kaustik/scene/scene_cameras.h"
#include "tests/scene/camera_support.h"
#include "tests/scene/scene_support.h"

namespace kaustik {
namespace {

using namespace test;

const std::string meter = "<sensor type=\"irradiancemeter\"/>";

// Straight from above to points that are uniform by area, from so near that nothing fits between.
TEST(IrradianceMeter, MeetsItsShape) {
  const auto shape = shape_of("sphere", {{"radius", Value(2.0), {}}});
  const auto camera = camera_of("irradiancemeter", {}, film_of(1, 1), shape);
  EXPECT_FALSE(camera->traits().can_connect);
  RunningStatistics z, squares;
  for (uint32_t i = 0; i < 4096; ++i) {
    Sampler sampler(1, i);
    const CameraRay ray = camera->sample_ray({0.5f, 0.5f}, camera->lens_numbers(sampler));
    const Vec3f normal = normalize(ray.origin);
    EXPECT_GT(length(ray.origin), 2);
    EXPECT_LT(length(ray.origin), 2.0005f);
    EXPECT_LT(length(ray.direction + normal), 1e-3f);
    z.add(double(normal.z));
    squares.add(double(normal.z * normal.z));
  }
  EXPECT_NEAR(z.mean(), 0, 2e-3);
  EXPECT_NEAR(squares.mean(), 1.0 / 3, 2e-3);
  // Where coordinates have no rounding, too, rays begin before the shape, not on it.
  const auto of_square = camera_of("irradiancemeter", {}, film_of(1, 1), shape_of("rectangle"));
  EXPECT_GT(of_square->sample_ray({0.5f, 0.5f}, {}).origin.z, 0);
  EXPECT_LT(of_square->sample_ray({0.5f, 0.5f}, {}).origin.z, 1e-5f);
}

// From a shape that light passes rays go into the hemisphere by the cosine, and count π times.
TEST(IrradianceMeter, LooksFromAShapeThatLightPasses) {
  const auto camera = camera_of("irradiancemeter", {}, film_of(1, 1), shape_of("rectangle"), true);
  EXPECT_EQ(camera->traits().weight, pi);
  RunningStatistics x, x_squares, cosine, to_side;
  for (uint32_t i = 0; i < 4096; ++i) {
    Sampler sampler(1, i);
    const CameraRay ray = camera->sample_ray({0.5f, 0.5f}, camera->lens_numbers(sampler));
    EXPECT_GE(ray.origin.z, 0);
    x.add(double(ray.origin.x));
    x_squares.add(double(ray.origin.x * ray.origin.x));
    cosine.add(double(ray.direction.z));
    to_side.add(double(ray.direction.y * ray.origin.y));
  }
  EXPECT_NEAR(x.mean(), 0, 2e-3);
  EXPECT_NEAR(x_squares.mean(), 1.0 / 3, 2e-3);
  EXPECT_NEAR(cosine.mean(), 2.0 / 3, 2e-3);
  EXPECT_NEAR(to_side.mean(), 0, 3 * to_side.standard_error());  // independent of the place
}

TEST(IrradianceMeter, StandsInAShape) {
  const auto scene = scene_of("<shape type=\"rectangle\">" + meter + "</shape>");
  EXPECT_EQ(scene->quantity(), Quantity::irradiance);
  EXPECT_TRUE(scene->warnings().empty());
  const auto passed =
      scene_of("<shape type=\"rectangle\">" + meter + "<bsdf type=\"null\"/></shape>");
  EXPECT_EQ(passed->quantity(), Quantity::irradiance);
  EXPECT_EQ(passed->film().quantity, Quantity::radiance);
  expect_problem(meter + any_shape, "2:1", "stands outside of a shape", "put it into");
  expect_problem("<shape type=\"sphere\"><sensor type=\"perspective\"/></shape>", "2:22",
                 "cannot belong to a shape", "top of the scene");
  expect_problem("<shape type=\"sdf\">" + meter + "</shape>", "2:19", "cannot be sampled",
                 "analytic");
}

// Where a shape is placed again and again there is no one to look from.
TEST(IrradianceMeter, HasNoEffectInPlacedScenes) {
  const std::string instance = "<shape type=\"instance\"><ref id=\"g\"/></shape>";
  const auto placed = [&](const std::string& inside) {
    return std::string(any_camera) +
           "\n<shape type=\"shapegroup\" id=\"g\"><shape type=\"sphere\">" + meter + inside +
           "</shape></shape>" + instance + instance;
  };
  for (const std::string inside : {"", "<emitter type=\"area\"/>"}) {
    const auto scene = scene_of(placed(inside));
    EXPECT_EQ(scene->quantity(), Quantity::radiance);
    ASSERT_EQ(scene->warnings().size(), 1u);
    EXPECT_NE(scene->warnings()[0].find("has no effect"), std::string::npos);
  }
  EXPECT_NE(scene_of(placed(""))->warnings()[0].find("test.xml:3:54: a sensor of a shape"),
            std::string::npos)
      << scene_of(placed(""))->warnings()[0];
  Description strict = description_of(placed(""));
  strict.is_strict = true;
  EXPECT_THROW(build_scene(strict), Error);
}

// All directions alike, from one point.
TEST(FluenceMeter, LooksEverywhere) {
  const auto camera = camera_of(
      "fluencemeter", {{"to_world", Value(Transform::translate({1, 2, 3})), {}}}, film_of(1, 1));
  EXPECT_FALSE(camera->traits().can_connect);
  EXPECT_EQ(camera->traits().weight, 1);
  Vec3d sum(0, 0, 0), squares(0, 0, 0);
  constexpr uint32_t rays = 4096;
  for (uint32_t i = 0; i < rays; ++i) {
    Sampler sampler(1, i);
    const CameraRay ray = camera->sample_ray({0.5f, 0.5f}, camera->lens_numbers(sampler));
    EXPECT_EQ(ray.origin, Vec3f(1, 2, 3));
    EXPECT_NEAR(length(ray.direction), 1, 1e-6);
    sum += Vec3d(ray.direction) / rays;
    squares += Vec3d(ray.direction * ray.direction) / rays;
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(sum[axis], 0, 2e-3);
    EXPECT_NEAR(squares[axis], 1.0 / 3, 2e-3);
  }
}

TEST(RadianceMeter, LooksAlongOneRay) {
  const auto expect_ray = [](const std::vector<Property>& properties, const Vec3f& origin,
                             const Vec3f& direction) {
    const auto camera = camera_of("radiancemeter", properties);
    for (const Vec2f& raster : {Vec2f(0, 0), Vec2f(31, 7)}) {
      const CameraRay ray = camera->sample_ray(raster, {});
      EXPECT_LT(length(ray.origin - origin), 1e-6f);
      EXPECT_LT(length(ray.direction - normalize(direction)), 1e-6f);
    }
  };
  const Property origin{"origin", Value(Vec3d(1, 2, 3)), {}},
      direction{"direction", Value(Vec3d(0, -3, 4)), {}},
      placed{"to_world", Value(Transform::translate({5, 6, 7})), {}};
  expect_ray({}, {0, 0, 0}, {0, 0, 1});
  expect_ray({origin, direction}, {1, 2, 3}, {0, -3, 4});
  expect_ray({placed}, {5, 6, 7}, {0, 0, 1});
  expect_ray({placed, origin, direction}, {5, 6, 7}, {0, 0, 1});  // as in Mitsuba
  EXPECT_THROW(camera_of("radiancemeter", {origin}), Error);
  EXPECT_THROW(camera_of("radiancemeter", {direction}), Error);
  EXPECT_THROW(camera_of("radiancemeter", {origin, {"direction", Value(Vec3d(0, 0, 0)), {}}}),
               Error);
}

// From outside of the scene, which camera_support.h gives a box from −1 to 1.
TEST(Distant, LooksFromBeyondTheScene) {
  const Vec3f direction = normalize(Vec3f(1, -2, 2));
  const Property along{"direction", Value(Vec3d(1, -2, 2)), {}};
  const float radius = std::sqrt(3.0f);
  const auto each_ray = [&](const Camera& camera, const auto& check) {
    for (uint32_t i = 0; i < 1000; ++i) {
      Sampler sampler(1, i);
      const CameraRay ray = camera.sample_ray({0.5f, 0.5f}, camera.lens_numbers(sampler));
      EXPECT_LT(length(ray.direction - direction), 1e-6f);
      EXPECT_LT(dot(ray.origin, direction), -radius);
      check(ray, ray.origin - direction * dot(ray.origin, direction));
    }
  };
  // The cross-section of the sphere around the scene, evenly: the mean of r² is R²/2.
  RunningStatistics squares;
  each_ray(*camera_of("distant", {along}), [&](const CameraRay&, const Vec3f& across) {
    EXPECT_LT(length(across), radius * 1.0001f);
    squares.add(double(length_sq(across)));
  });
  EXPECT_NEAR(squares.mean(), 1.5, 0.01);
  // A point.
  const Vec3f target(0.3f, 0.2f, -0.5f);
  each_ray(*camera_of("distant", {along, {"target", Value(Vec3d(target)), {}}}),
           [&](const CameraRay& ray, const Vec3f&) {
             const Vec3f to_target = target - ray.origin;
             EXPECT_LT(length(to_target - direction * dot(to_target, direction)), 1e-5f);
           });
  // A shape: points of the square from −1 to 1 in the plane z = 0.
  RunningStatistics x_squares;
  each_ray(*camera_of("distant", {along}, film_of(1, 1), shape_of("rectangle")),
           [&](const CameraRay& ray, const Vec3f&) {
             const Vec3f met = ray.origin - direction * (ray.origin.z / direction.z);
             EXPECT_LE(max_abs(met), 1.00001f);
             x_squares.add(double(met.x * met.x));
           });
  EXPECT_NEAR(x_squares.mean(), 1.0 / 3, 0.01);
}

TEST(Distant, TakesOneTarget) {
  const auto scene =
      scene_of("<sensor type=\"distant\"><shape type=\"disk\"/></sensor>" + std::string(any_shape));
  EXPECT_EQ(scene->surface_count(), 1u);  // the target is none of the scene's shapes
  expect_problem(
      "<sensor type=\"distant\"><point name=\"target\" value=\"0, 0, 0\"/><shape type=\"disk\"/>"
      "</sensor>" +
          std::string(any_shape),
      "2:24", "two targets", "keep one");
  expect_problem("<sensor type=\"distant\"><shape type=\"sdf\"/></sensor>" + std::string(any_shape),
                 "2:1", "cannot be sampled");
  expect_problem(
      "<sensor type=\"perspective\"><shape type=\"disk\"/></sensor>" + std::string(any_shape),
      "2:28", "cannot hold a shape");
}

const std::string batch =
    R"(<sensor type="batch"><sensor type="perspective" id="front"/>
    <sensor type="orthographic" name="plan"/><shape type="sphere">)" +
    meter + R"(</shape><film type="hdrfilm"><integer name="width" value="31"/>
    <integer name="height" value="20"/></film></sensor>)";

// Each of its sensors is a camera, with its share of the width.
TEST(Batch, HoldsCameras) {
  const auto chosen = [&](const std::string& name) {
    Description description = description_of(batch + any_shape);
    choose_camera(description, name);
    EXPECT_EQ(cameras_of(*description.scene).size(), 1u);
    return build_scene(description);
  };
  EXPECT_GT(chosen("front")->camera().traits().horizontal_fov, 0);
  EXPECT_GT(chosen("plan")->camera().traits().parallel_distance, 0);
  const auto of_meter = chosen("sensor2");
  EXPECT_EQ(of_meter->quantity(), Quantity::irradiance);
  EXPECT_EQ(of_meter->film().size, Vec2i(10, 20));
  // All shapes are there, whichever camera sees them.
  EXPECT_EQ(of_meter->surface_count(), 2u);
  EXPECT_EQ(chosen("front")->surface_count(), 2u);
  EXPECT_THROW(chosen("back"), Error);
  Description description = description_of(batch + any_shape);
  EXPECT_EQ(choose_camera(description, ""),
            "the scene has 3 cameras: 'front' is used, the others are left out: 'plan', 'sensor2'");
}

// A shape of the scene that a batch refers to stays one shape.
TEST(Batch, RefersToShapesOfTheScene) {
  Description description =
      description_of(R"(<shape type="sphere" id="ball">)" + meter +
                     R"(</shape><sensor type="batch"><ref id="ball" name="ball"/>
                     <sensor type="perspective" id="front"/></sensor>)");
  EXPECT_EQ(cameras_of(*description.scene).size(), 2u);
  choose_camera(description, "ball");
  const auto scene = build_scene(description);
  EXPECT_EQ(scene->quantity(), Quantity::irradiance);
  EXPECT_EQ(scene->surface_count(), 1u);
}

// Programs may build a scene without asking for a camera.
TEST(Batch, TheFirstCameraIsUsed) {
  const Description description = description_of(batch + any_shape);
  const auto scene = build_scene(description);
  EXPECT_GT(scene->camera().traits().horizontal_fov, 0);
  EXPECT_EQ(scene->warnings().size(), 2u);
  // The description stays as it was.
  EXPECT_EQ(description.scene->children.at(0).object->type, "batch");
  expect_problem("<sensor type=\"batch\"/>" + std::string(any_shape), "2:1", "holds no camera");
}

// Cameras in shapes are cameras of the scene; a shape that loses its stays.
TEST(Cameras, InShapes) {
  const std::string text =
      "<shape type=\"sphere\"><sensor type=\"irradiancemeter\" id=\"meter\"/>"
      "</shape><sensor type=\"perspective\" id=\"eye\"/>";
  const auto chosen = [&](const std::string& name) {
    Description description = description_of(text);
    choose_camera(description, name);
    return build_scene(description);
  };
  EXPECT_EQ(chosen("meter")->quantity(), Quantity::irradiance);
  EXPECT_EQ(chosen("eye")->quantity(), Quantity::radiance);
  EXPECT_EQ(chosen("eye")->surface_count(), 1u);
  EXPECT_EQ(scene_of(text)->quantity(), Quantity::irradiance);  // the first
}

TEST(Cameras, ASpectralResponseIsTold) {
  const auto scene = scene_of(
      "<sensor type=\"radiancemeter\"><spectrum name=\"srf\" value=\"400:1, 700:2\"/></sensor>" +
      std::string(any_shape));
  ASSERT_EQ(scene->warnings().size(), 1u);
  EXPECT_EQ(scene->warnings()[0],
            "without effect here: 'srf' of sensor 'radiancemeter' (test.xml:2:30)");
}

}  // namespace
}  // namespace kaustik
