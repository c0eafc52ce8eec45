// The pinhole: where rays go, where points appear, and that both agree in measure.

#include "kaustik/base/sampler.h"
#include "kaustik/base/statistics.h"
#include "tests/scene/camera_support.h"
#include "tests/scene/scene_support.h"
#include "tests/support/type_rows.h"

namespace kaustik {
namespace {

using namespace test;

constexpr double degrees = 180 / std::numbers::pi;

struct View {
  std::string name;
  std::string inside;  ///< of the sensor
};

/// Cameras of all kinds of field of view, shape, crop and place.
std::vector<View> views() {
  const auto fov = [](const std::string& axis, double value) {
    return "<string name=\"fov_axis\" value=\"" + axis + "\"/><float name=\"fov\" value=\"" +
           std::to_string(value) + "\"/>";
  };
  const std::string crop =
      "<integer name=\"crop_offset_x\" value=\"7\"/><integer name=\"crop_offset_y\" value=\"3\"/>"
      "<integer name=\"crop_width\" value=\"20\"/><integer name=\"crop_height\" value=\"11\"/>";
  const std::string placed =
      "<transform name=\"to_world\"><lookat origin=\"1,2,3\" target=\"-4,0.5,1\" up=\"0,0,1\"/>"
      "</transform>";
  const std::string shifted =
      "<float name=\"principal_point_offset_x\" value=\"0.2\"/>"
      "<float name=\"principal_point_offset_y\" value=\"-0.3\"/>";
  return {{"default", film(32, 24)},
          {"x", fov("x", 60) + film(32, 24)},
          {"y", fov("y", 60) + film(32, 24)},
          {"diagonal", fov("diagonal", 60) + film(32, 24)},
          {"smaller, wide", fov("smaller", 60) + film(32, 24)},
          {"smaller, tall", fov("smaller", 60) + film(24, 32)},
          {"larger, wide", fov("larger", 60) + film(32, 24)},
          {"larger, tall", fov("larger", 60) + film(24, 32)},
          {"very wide", fov("x", 150) + film(32, 24)},
          {"cropped", fov("x", 60) + film(32, 24, crop)},
          {"placed and cropped", fov("y", 80) + placed + film(40, 24, crop)},
          {"shifted", fov("x", 60) + shifted + film(32, 24)},
          {"all", fov("diagonal", 95) + shifted + placed + film(40, 24, crop)}};
}

TEST(Camera, FieldsOfViewByAxis) {
  const double wide = 4.0 / 3, t = std::tan(30 / degrees);
  const auto horizontal = [](double tangent) { return 2 * std::atan(tangent) * degrees; };
  const std::vector<std::pair<std::string, double>> expected = {
      {"x", t},
      {"y", t * wide},
      {"diagonal", t * wide / std::hypot(wide, 1)},
      {"smaller, wide", t * wide},
      {"smaller, tall", t},
      {"larger, wide", t},
      {"larger, tall", t / wide},
      // 50 mm on 36 × 24 mm film, along the diagonal
      {"default", std::hypot(36, 24) / 100 * wide / std::hypot(wide, 1)}};
  for (const auto& [name, tangent] : expected)
    for (const View& view : views())
      if (view.name == name) {
        const auto scene = seen_by(view.inside);
        const double aspect = double(scene->film().size.x) / scene->film().size.y;
        EXPECT_NEAR(scene->camera().traits().horizontal_fov, horizontal(tangent), 1e-3) << name;
        EXPECT_NEAR(scene->camera().traits().vertical_fov, horizontal(tangent / aspect), 1e-3)
            << name;
      }
}

/// What each type needs, at least.
std::unique_ptr<Camera> simplest(const CameraType& type) {
  std::vector<Property> needed;
  for (const Parameter& row : type.info.parameters)
    if (row.required || row.name == "aperture_radius") needed.push_back({row.name, Value(0.1), {}});
  return camera_of(type.info.name, needed, film_of(32, 24),
                   type.needs_shape ? shape_of("rectangle") : nullptr);
}

// What any camera promises: a point on a ray that it draws is seen where that was drawn for,
// through the same point of the lens, or no light path is connected to it at all.
TEST(Camera, EveryTypeSeesPointsWhereItsRaysGo) {
  for (const CameraType& type : camera_types()) {
    SCOPED_TRACE(type.info.name);
    const std::unique_ptr<Camera> camera = simplest(type);
    int rays = 0;
    for (uint32_t i = 0; i < 100; ++i) {
      Sampler sampler(11, i);
      const Vec2f raster = sampler.next_2d() * Vec2f(32, 24);
      const LensNumbers lens = camera->lens_numbers(sampler);
      const CameraRay ray = camera->sample_ray(raster, lens);
      if (ray.is_none()) continue;
      ++rays;
      EXPECT_NEAR(length(ray.direction), 1, 1e-5);
      const float distance = 0.5f + 10 * sampler.next_1d();
      const CameraConnection seen = camera->connect(ray.origin + ray.direction * distance, lens);
      if (!camera->traits().can_connect) {
        EXPECT_EQ(seen.importance, 0);
        EXPECT_GT(seen.distance, 0);  // by whose square others divide
        continue;
      }
      EXPECT_GT(seen.importance, 0);
      EXPECT_NEAR(seen.raster.x, raster.x, 1e-3);
      EXPECT_NEAR(seen.raster.y, raster.y, 1e-3);
      EXPECT_NEAR(seen.distance, distance, 1e-4f * distance);
      EXPECT_LT(length(seen.lens - ray.origin), 1e-5f);
      EXPECT_LT(length(seen.direction + ray.direction), 1e-5f);
    }
    EXPECT_GT(rays, 40);
  }
}

// What is nearer or farther is cut off, for rays and for light paths alike.
TEST(Camera, ClipsWhatIsNearAndFar) {
  const std::vector<Property> planes = {{"near_clip", Value(2.0), {}},
                                        {"far_clip", Value(5.0), {}}};
  for (const CameraType& type : camera_types()) {
    if (!type.info.find("near_clip")) continue;
    SCOPED_TRACE(type.info.name);
    std::vector<Property> given = planes;
    if (type.info.find("aperture_radius")) given.push_back({"aperture_radius", Value(0.3), {}});
    const std::unique_ptr<Camera> camera = camera_of(type.info.name, given);
    // Along the direction of view, or from the camera where it looks all around.
    const bool is_straight =
        camera->traits().horizontal_fov > 0 || camera->traits().parallel_distance > 0;
    for (uint32_t i = 0; i < 50; ++i) {
      Sampler sampler(3, i);
      const Vec2f raster = sampler.next_2d() * Vec2f(32, 24);
      const LensNumbers lens = camera->lens_numbers(sampler);
      const CameraRay ray = camera->sample_ray(raster, lens);
      if (ray.is_none()) continue;
      const float cosine = is_straight ? ray.direction.z : 1;
      EXPECT_NEAR(ray.start * cosine, 2, 1e-5);
      EXPECT_NEAR(ray.t_max * cosine, 3, 1e-5);
      const auto seen_at = [&](float t) {
        return camera->connect(ray.origin + ray.direction * t, lens);
      };
      EXPECT_GT(seen_at(0.01f).importance, 0);
      EXPECT_GT(seen_at(0.99f * ray.t_max).importance, 0);
      EXPECT_EQ(seen_at(-0.01f).importance, 0);
      EXPECT_EQ(seen_at(1.01f * ray.t_max).importance, 0);
      // Light paths end where rays begin, but are measured to the lens.
      EXPECT_LT(length(seen_at(1).lens - ray.origin), 1e-5f);
      EXPECT_NEAR(seen_at(1).distance, ray.start + 1, 1e-4);
    }
    // Without them nothing is.
    given.erase(given.begin(), given.begin() + 2);
    const CameraRay whole = camera_of(type.info.name, given)->sample_ray({16, 12}, {});
    EXPECT_EQ(whole.start, 0);
    EXPECT_EQ(whole.t_max, infinity);
  }
  EXPECT_THROW(
      camera_of("perspective", {{"near_clip", Value(2.0), {}}, {"far_clip", Value(2.0), {}}}),
      Error);
}

// The aperture is measured in the world, whatever the scale of the picture; where the picture is
// sharp it is that of the orthographic camera.
TEST(Camera, TelecentricLooksThroughCones) {
  const Transform placed = Transform::translate({1, 2, 3}) * Transform::scale({4, 4, 2});
  const Property to_world{"to_world", Value(placed), {}};
  const auto pinhole = camera_of("orthographic", {to_world});
  const auto camera = camera_of(
      "telecentric",
      {to_world, {"aperture_radius", Value(0.5), {}}, {"focus_distance", Value(2.0), {}}});
  EXPECT_TRUE(camera->traits().has_lens);
  RunningStatistics x_squares, y_squares;
  for (uint32_t i = 0; i < 4096; ++i) {
    Sampler sampler(7, i);
    const LensNumbers lens = camera->lens_numbers(sampler);
    const Vec2f raster = sampler.next_2d() * Vec2f(32, 24);
    const Ray ray = camera->sample_ray(raster, lens), straight = pinhole->sample_ray(raster, {});
    const Vec3f off = ray.origin - straight.origin;
    EXPECT_NEAR(off.z, 0, 1e-6);
    EXPECT_LT(length(off), 0.50001f);
    x_squares.add(double(off.x * off.x));
    y_squares.add(double(off.y * off.y));
    const Vec3f sharp = ray.origin + ray.direction * (2 / ray.direction.z);
    EXPECT_LT(length(sharp - (straight.origin + Vec3f(0, 0, 2))), 1e-5f);
  }
  EXPECT_NEAR(x_squares.mean(), 0.25 / 4, 1e-3);
  EXPECT_NEAR(y_squares.mean(), 0.25 / 4, 1e-3);
  // Without an aperture it is the orthographic one.
  const auto closed = camera_of("telecentric", {to_world});
  EXPECT_FALSE(closed->traits().has_lens);
  EXPECT_EQ(closed->sample_ray({3, 4}, {}).direction, Vec3f(0, 0, 1));
  EXPECT_THROW(camera_of("telecentric", {{"blades", Value(int64_t(2)), {}}}), Error);
}

// The scale of to_world is half of the width; the height follows from the picture's shape.
TEST(Camera, OrthographicSeesAlongParallelLines) {
  const Transform placed = Transform::translate({1, 2, 3}) * Transform::scale({4, 4, 1});
  const auto camera = camera_of("orthographic", {{"to_world", Value(placed), {}}});
  const Ray corner = camera->sample_ray({0, 0}, {}), other = camera->sample_ray({32, 24}, {});
  EXPECT_LT(length(corner.origin - Vec3f(5, 5, 3)), 1e-5f);
  EXPECT_LT(length(other.origin - Vec3f(-3, -1, 3)), 1e-5f);
  EXPECT_EQ(corner.direction, Vec3f(0, 0, 1));
  EXPECT_EQ(other.direction, Vec3f(0, 0, 1));
  // A pixel is 0.25 m wide, at every distance.
  for (const float distance : {0.5f, 7.0f}) {
    const CameraConnection seen = camera->connect(corner.origin + Vec3f(0, 0, distance), {});
    EXPECT_NEAR(seen.importance / (distance * distance), 16, 1e-4);
  }
  EXPECT_EQ(camera->connect(corner.origin - Vec3f(0, 0, 1), {}).importance, 0);
  EXPECT_NEAR(camera->traits().pixel_width, 0.125, 1e-6);
  EXPECT_EQ(camera->traits().pixel_spread, 0);
}

TEST(Camera, FocalLength) {
  const auto scene = seen_by("<string name=\"focal_length\" value=\"35mm\"/>" + film(36, 24));
  EXPECT_NEAR(scene->camera().traits().horizontal_fov, 2 * std::atan(18.0 / 35) * degrees, 1e-3);
  expect_problem(
      "<sensor type=\"perspective\">\n<string name=\"focal_length\" value=\"wide\"/></sensor>" +
          std::string(any_shape),
      "3:1", "'focal_length' is 'wide'", "35mm");
}

TEST(Camera, TwoFieldsOfView) {
  expect_problem(
      "<sensor type=\"perspective\"><float name=\"fov\" value=\"40\"/>\n<string "
      "name=\"focal_length\" value=\"50mm\"/></sensor>" +
          std::string(any_shape),
      "3:1", "has both 'focal_length' and 'fov'", "give one of them");
}

TEST(Camera, LooksAlongZWithXToTheLeft) {
  const auto scene = seen_by("<float name=\"fov\" value=\"90\"/>" + film(32, 32));
  const Camera& camera = scene->camera();
  const auto expect_direction = [&](const Vec2f& raster, const Vec3f& direction) {
    EXPECT_LT(length(camera.sample_ray(raster, Camera::middle_of_lens()).direction -
                     normalize(direction)),
              1e-6f);
  };
  expect_direction({16, 16}, {0, 0, 1});
  expect_direction({0, 16}, {1, 0, 1});
  expect_direction({32, 16}, {-1, 0, 1});
  expect_direction({16, 0}, {0, 1, 1});
  expect_direction({32, 32}, {-1, -1, 1});
}

TEST(Camera, LookAtPutsTheTargetInTheMiddle) {
  const auto scene = seen_by(
      "<transform name=\"to_world\"><lookat origin=\"1,2,3\" target=\"-4,0.5,1\" up=\"0,0,1\"/>"
      "</transform>" +
      film(32, 24));
  EXPECT_EQ(scene->camera().traits().position, Vec3f(1, 2, 3));
  const CameraConnection seen = scene->camera().connect({-4, 0.5f, 1}, Camera::middle_of_lens());
  EXPECT_NEAR(seen.raster.x, 16, 1e-3);
  EXPECT_NEAR(seen.raster.y, 12, 1e-3);
  EXPECT_LT(scene->camera().connect({-4, 0.5f, 1.2f}, Camera::middle_of_lens()).raster.y,
            12);  // up is up
}

// As in Mitsuba: the picture's centre is what an unshifted camera sees at 0.5 + offset.
TEST(Camera, PrincipalPoint) {
  const auto straight = seen_by(film(32, 24));
  const auto shifted = seen_by(
      "<float name=\"principal_point_offset_x\" value=\"0.25\"/>"
      "<float name=\"principal_point_offset_y\" value=\"-0.125\"/>" +
      film(32, 24));
  EXPECT_LT(length(shifted->camera().sample_ray({16, 12}, Camera::middle_of_lens()).direction -
                   straight->camera().sample_ray({24, 9}, Camera::middle_of_lens()).direction),
            1e-6f);
}

TEST(Camera, CropWindowsSeeTheirPartOfThePicture) {
  const std::string crop =
      "<integer name=\"crop_offset_x\" value=\"7\"/><integer name=\"crop_offset_y\" value=\"3\"/>"
      "<integer name=\"crop_width\" value=\"20\"/><integer name=\"crop_height\" value=\"11\"/>";
  const auto whole = seen_by(film(32, 24)), part = seen_by(film(32, 24, crop));
  for (const Vec2f& raster : {Vec2f(0, 0), Vec2f(3.5f, 7.25f), Vec2f(20, 11)}) {
    const Vec3f direction = part->camera().sample_ray(raster, Camera::middle_of_lens()).direction;
    EXPECT_EQ(direction,
              whole->camera().sample_ray(raster + Vec2f(7, 3), Camera::middle_of_lens()).direction);
    const Vec3f point = direction * 3.0f;
    EXPECT_NEAR(part->camera().connect(point, Camera::middle_of_lens()).raster.x + 7,
                whole->camera().connect(point, Camera::middle_of_lens()).raster.x, 1e-4);
    EXPECT_EQ(part->camera().connect(point, Camera::middle_of_lens()).importance,
              whole->camera().connect(point, Camera::middle_of_lens()).importance);
  }
  EXPECT_EQ(part->camera().traits().pixel_spread, whole->camera().traits().pixel_spread);
  EXPECT_EQ(part->camera().traits().horizontal_fov, whole->camera().traits().horizontal_fov);
}

TEST(Camera, PointsOnRaysAppearWhereTheRaysStarted) {
  for (const View& view : views()) {
    SCOPED_TRACE(view.name);
    const auto scene = seen_by(view.inside);
    const Camera& camera = scene->camera();
    const Vec2i size = scene->film().crop_size;
    for (uint32_t i = 0; i < 500; ++i) {
      Sampler sampler(1, i);
      const Vec2f u = sampler.next_2d();
      const Vec2f raster(u.x * float(size.x), u.y * float(size.y));
      const float distance = std::exp(10 * sampler.next_1d() - 5);
      const Ray ray = camera.sample_ray(raster, Camera::middle_of_lens());
      EXPECT_NEAR(length(ray.direction), 1, 1e-6);
      EXPECT_EQ(ray.origin, camera.traits().position);
      EXPECT_FALSE(camera.traits().has_lens);
      const CameraConnection seen =
          camera.connect(ray.origin + ray.direction * distance, Camera::middle_of_lens());
      const float rounding = 2e-3f + 2e-5f / distance;  // of points near a camera far from 0
      EXPECT_NEAR(seen.raster.x, raster.x, rounding);
      EXPECT_NEAR(seen.raster.y, raster.y, rounding);
      EXPECT_NEAR(seen.distance, distance, 1e-5f * distance + 1e-6f);
      EXPECT_LT(length(seen.direction + ray.direction), 1e-4f + 1e-6f / distance);
      EXPECT_GT(seen.importance, 0);
    }
  }
}

/// ∫ dω over the rectangle from (0, 0) to (x, y) on the plane at distance 1.
double corner_solid_angle(double x, double y) {
  return std::atan(x * y / std::sqrt(1 + x * x + y * y));
}

/// Of what the camera's picture covers.
double solid_angle(const Scene& scene) {
  const Vec2i size = scene.film().crop_size;
  const Camera& camera = scene.camera();
  // In the camera's own frame: its axis and two edges of the picture.
  const Vec3f upper_left = camera.sample_ray({0, 0}, Camera::middle_of_lens()).direction;
  const Vec3f upper_right =
      camera.sample_ray({float(size.x), 0}, Camera::middle_of_lens()).direction;
  const Vec3f lower_right =
      camera.sample_ray({float(size.x), float(size.y)}, Camera::middle_of_lens()).direction;
  const Vec3f lower_left =
      camera.sample_ray({0, float(size.y)}, Camera::middle_of_lens()).direction;
  // Girard: a spherical quadrilateral's area is the excess of its angles.
  const auto angle = [](const Vec3f& a, const Vec3f& b, const Vec3f& c) {
    const Vec3d at(b), to_a = (at % Vec3d(a)).normalized(), to_c = (at % Vec3d(c)).normalized();
    return std::acos(to_a ^ to_c);
  };
  return angle(lower_left, upper_left, upper_right) + angle(upper_left, upper_right, lower_right) +
         angle(upper_right, lower_right, lower_left) + angle(lower_right, lower_left, upper_left) -
         2 * std::numbers::pi;
}

/// ∫ 1/importance over the raster, by the midpoint rule; `power` spoils the importance by cosines
/// (for a camera that looks along z).
double integral_of_inverse_importance(const Scene& scene, int power = 0) {
  constexpr int steps = 400;
  const Camera& camera = scene.camera();
  const Vec2i size = scene.film().crop_size;
  double sum = 0;
  const Vec3f axis(0, 0, 1);
  for (int y = 0; y < steps; ++y)
    for (int x = 0; x < steps; ++x) {
      const Vec2f raster((float(x) + 0.5f) / steps * float(size.x),
                         (float(y) + 0.5f) / steps * float(size.y));
      const Ray ray = camera.sample_ray(raster, Camera::middle_of_lens());
      const double cosine = power == 0 ? 1 : double(dot(ray.direction, axis));
      sum += std::pow(cosine, power) /
             double(camera.connect(ray.origin + ray.direction * 2.0f, Camera::middle_of_lens())
                        .importance);
    }
  return sum * size.x * size.y / (double(steps) * steps);
}

TEST(Camera, ImportanceIsRasterAreaPerSolidAngle) {
  for (const View& view : views()) {
    const auto scene = seen_by(view.inside);
    const double expected = solid_angle(*scene);
    EXPECT_NEAR(integral_of_inverse_importance(*scene), expected, 1e-4 * expected) << view.name;
  }
}

TEST(Camera, TheSolidAngleOfThatTestIsRight) {
  const auto scene = seen_by("<float name=\"fov\" value=\"60\"/>" + film(32, 24));
  const double x = std::tan(30 / degrees), y = x * 24 / 32;
  EXPECT_NEAR(solid_angle(*scene), 4 * corner_solid_angle(x, y), 1e-5);
}

// The twin of the test above: a power of the cosine too many or too few does not pass.
TEST(Camera, AWrongImportanceWouldBeFound) {
  const auto scene = seen_by("<float name=\"fov\" value=\"60\"/>" + film(32, 24));
  const double expected = solid_angle(*scene);
  for (const int power : {1, -1})
    EXPECT_GT(std::fabs(integral_of_inverse_importance(*scene, power) / expected - 1), 0.02);
}

TEST(Camera, SeesNothingBehindOrFarOutside) {
  const auto scene = seen_by("<float name=\"fov\" value=\"60\"/>" + film(32, 24));
  const Camera& camera = scene->camera();
  EXPECT_GT(camera.connect({0, 0, 5}, Camera::middle_of_lens()).importance, 0);
  EXPECT_EQ(camera.connect({0, 0, -5}, Camera::middle_of_lens()).importance, 0);
  EXPECT_EQ(camera.connect({0, 0, 0}, Camera::middle_of_lens()).importance, 0);
  EXPECT_EQ(camera.connect({5, 0, 0}, Camera::middle_of_lens()).importance, 0);
  EXPECT_EQ(camera.connect({9, 0, 1}, Camera::middle_of_lens()).importance, 0);
  // Just outside counts: the filter reaches in.
  const Vec3f near_edge = camera.sample_ray({-1, 12}, Camera::middle_of_lens()).direction;
  EXPECT_GT(camera.connect(near_edge, Camera::middle_of_lens()).importance, 0);
}

TEST(Camera, PixelSpreadIsHalfAPixel) {
  const auto scene = seen_by("<float name=\"fov\" value=\"60\"/>" + film(320, 240));
  const Vec3f a = scene->camera().sample_ray({160, 120}, Camera::middle_of_lens()).direction;
  const Vec3f b = scene->camera().sample_ray({161, 120}, Camera::middle_of_lens()).direction;
  EXPECT_NEAR(scene->camera().traits().pixel_spread, 0.5f * length(a - b), 1e-5f);
}

TEST(Camera, TransformsThatDoNotFit) {
  const auto placed = [](const std::string& operations) {
    return "<sensor type=\"perspective\">\n<transform name=\"to_world\">" + operations +
           "</transform></sensor>" + any_shape;
  };
  expect_problem(placed("<scale x=\"2\"/>"), "3:1", "stretches or shears", "uniform scales");
  const auto scaled = scene_of(placed("<scale value=\"3\"/><translate x=\"1\"/>"));
  EXPECT_LT(length(scaled->camera().sample_ray({0, 0}, Camera::middle_of_lens()).direction -
                   seen_by("")->camera().sample_ray({0, 0}, Camera::middle_of_lens()).direction),
            1e-6f);
  EXPECT_EQ(scaled->camera().traits().position, Vec3f(1, 0, 0));
  // A mirrored camera is fine.
  EXPECT_LT(scene_of(placed("<scale x=\"-1\"/>"))
                ->camera()
                .sample_ray({0, 288}, Camera::middle_of_lens())
                .direction.x,
            0);
}

// Whoever takes lens numbers of a pinhole uses up none of the sampler's.
TEST(Camera, APinholeNeedsNoNumbers) {
  const auto scene = seen_by(film(32, 24));
  const Camera& camera = scene->camera();
  Sampler sampler(1, 2), same(1, 2);
  EXPECT_EQ(camera.lens_numbers(sampler), Camera::middle_of_lens());
  EXPECT_EQ(camera.forked_lens_numbers(sampler), Camera::middle_of_lens());
  EXPECT_EQ(sampler.next_2d(), same.next_2d());
  for (const Vec2f& u : {Vec2f(0, 0), Vec2f(0.3f, 0.9f)}) {
    EXPECT_EQ(camera.sample_ray({5, 7}, u).direction,
              camera.sample_ray({5, 7}, Camera::middle_of_lens()).direction);
    EXPECT_EQ(camera.connect({0.1f, 0.2f, 4}, u).lens, camera.traits().position);
  }
}

TEST(Camera, TypesAndFilmsAreRows) {
  expect_rows_of("sensor", camera_types());
  expect_rows_of("film", film_types());
  expect_problem(std::string("<sensor type=\"perspektive\"/>") + any_shape, "2:1", "perspektive",
                 "did you mean 'perspective'");
}

}  // namespace
}  // namespace kaustik
