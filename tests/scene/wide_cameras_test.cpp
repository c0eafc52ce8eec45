// Cameras that see more than straight lines: fisheyes, the sphere, the cylinder.

#include "kaustik/scene/filter_kinds.h"
#include "tests/scene/camera_support.h"
#include "tests/scene/scene_support.h"

namespace kaustik {
namespace {

using namespace test;

constexpr double degree = std::numbers::pi / 180;

/// A type with arguments, and the solid angle that all of its picture shows.
struct WideView {
  std::string name, type;
  std::vector<Property> properties;
  double solid_angle = 0;
};

WideView fisheye(const std::string& mapping, double fov) {
  return {mapping + " " + std::to_string(int(fov)),
          "fisheye",
          {{"mapping", Value(mapping), {}}, {"fov", Value(fov), {}}},
          2 * std::numbers::pi * (1 - std::cos(0.5 * fov * degree))};
}

/// In pictures of 320 × 240 pixels.
std::vector<WideView> wide_views() {
  const auto cylinder = [](double fov) {
    const double half_height = 0.5 * fov * degree * 240 / 320;
    return WideView{"cylinder " + std::to_string(int(fov)),
                    "cylinder",
                    {{"fov", Value(fov), {}}},
                    2 * fov * degree * std::sin(std::atan(half_height))};
  };
  return {fisheye("equidistant", 180),
          fisheye("equidistant", 60),
          fisheye("equidistant", 300),
          fisheye("equisolid", 180),
          fisheye("equisolid", 330),
          fisheye("stereographic", 180),
          fisheye("stereographic", 250),
          fisheye("hemispherical", 165),
          fisheye("hemispherical", 40),
          {"spherical", "spherical", {}, 4 * std::numbers::pi},
          cylinder(360),
          cylinder(200),
          cylinder(30)};
}

/// Turned and moved, so that no axis is the world's.
Property placed_elsewhere() {
  return {"to_world", Value(Transform::look_at({1, 2, 3}, {-4, 0.5, 1}, {0, 0, 1})), {}};
}

std::unique_ptr<Camera> wide_camera(const WideView& view, bool is_placed = false) {
  std::vector<Property> properties = view.properties;
  if (is_placed) properties.push_back(placed_elsewhere());
  return camera_of(view.type, properties, film_of(320, 240));
}

TEST(WideCamera, ImportanceIsRasterAreaPerSolidAngle) {
  for (const WideView& view : wide_views()) {
    SCOPED_TRACE(view.name);
    const auto camera = wide_camera(view, true);
    int seen = 0;
    for (uint32_t i = 0; i < 300; ++i) {
      Sampler sampler(2, i);
      const Vec2f raster = Vec2f(1, 1) + sampler.next_2d() * Vec2f(318, 238);
      const auto has_ray = [&](float dx, float dy) {
        return !camera->sample_ray(raster + Vec2f(dx, dy), {}).is_none();
      };
      // Near the rim, and near the poles, pixels differ much from one to the next.
      if (!has_ray(3, 0) || !has_ray(-3, 0) || !has_ray(0, 3) || !has_ray(0, -3)) continue;
      if (view.type == "spherical" && std::fabs(raster.y - 120) > 112) continue;
      EXPECT_NEAR(importance_error(*camera, raster, {}), 0, 3e-3) << raster.x << ", " << raster.y;
      ++seen;
    }
    EXPECT_GT(seen, 100);
  }
}

/// ∫ 1/importance over the raster, where there are rays: the solid angle that the picture shows.
/// `power` spoils the importance by cos² of half the angle with +z.
double shown_solid_angle(const Camera& camera, double power = 0) {
  constexpr int columns = 320, rows = 240;
  double sum = 0;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const CameraRay ray = camera.sample_ray({float(x) + 0.5f, float(y) + 0.5f}, {});
      if (ray.is_none()) continue;
      const float importance = camera.connect(ray.origin + ray.direction * 2.0f, {}).importance;
      sum += std::pow(0.5 + 0.5 * double(ray.direction.z), power) / double(importance);
    }
  return sum;
}

TEST(WideCamera, PicturesShowTheSolidAngleThatTheySay) {
  for (const WideView& view : wide_views()) {
    const double shown = shown_solid_angle(*wide_camera(view));
    EXPECT_NEAR(shown, view.solid_angle, 3e-3 * view.solid_angle) << view.name;
  }
}

// The twin.
TEST(WideCamera, AWrongImportanceWouldBeFound) {
  for (const WideView& view : {fisheye("equidistant", 180), fisheye("stereographic", 180)}) {
    const double shown = shown_solid_angle(*wide_camera(view), 0.1);
    EXPECT_GT(std::fabs(shown / view.solid_angle - 1), 0.01) << view.name;
  }
}

TEST(WideCamera, PointsAreSeenWhereRaysBegan) {
  for (const WideView& view : wide_views()) {
    SCOPED_TRACE(view.name);
    const auto camera = wide_camera(view, true);
    for (uint32_t i = 0; i < 500; ++i) {
      Sampler sampler(1, i);
      const Vec2f raster = sampler.next_2d() * Vec2f(320, 240);
      if (view.type == "spherical" && std::fabs(raster.y - 120) > 119) continue;  // a point
      const CameraRay ray = camera->sample_ray(raster, {});
      if (ray.is_none()) continue;
      EXPECT_NEAR(length(ray.direction), 1, 1e-6);
      const CameraConnection seen = camera->connect(ray.origin + ray.direction * 2.0f, {});
      EXPECT_LT((seen.raster - raster).length(), 0.02f) << raster.x << ", " << raster.y;
      EXPECT_GT(seen.importance, 0);
    }
  }
}

// Where 45° from the axis is seen, of a field of view of 180°.
TEST(Fisheye, MappingsByTheirFormulas) {
  const Vec3f point(-1, 0, 1);  // right of the middle
  const auto radius = [&](const std::string& mapping) {
    const auto camera = wide_camera(fisheye(mapping, 180));
    const Vec2f raster = camera->connect(point, {}).raster;
    EXPECT_NEAR(raster.y, 120, 1e-3);
    return double(raster.x - 160) / 120;
  };
  EXPECT_NEAR(radius("equidistant"), 0.5, 1e-5);
  EXPECT_NEAR(radius("equisolid"), std::sin(22.5 * degree) / std::sin(45 * degree), 1e-5);
  EXPECT_NEAR(radius("stereographic"), std::tan(22.5 * degree), 1e-5);
  EXPECT_NEAR(radius("hemispherical"), std::sin(45 * degree), 1e-5);
  // Up is up.
  EXPECT_LT(wide_camera(fisheye("equidistant", 180))->connect({0, 1, 1}, {}).raster.y, 120);
}

TEST(Fisheye, SeesNothingOutsideOfItsCircle) {
  for (const char* mapping : {"equidistant", "equisolid", "stereographic", "hemispherical"}) {
    SCOPED_TRACE(mapping);
    const auto camera = wide_camera(fisheye(mapping, 180));
    for (const Vec2f& raster : {Vec2f(1, 1), Vec2f(39, 120), Vec2f(281, 120), Vec2f(160, -0.1f)})
      EXPECT_TRUE(camera->sample_ray(raster, {}).is_none());
    for (const Vec2f& raster : {Vec2f(160, 120), Vec2f(41, 120), Vec2f(279, 120), Vec2f(160, 0.1f)})
      EXPECT_FALSE(camera->sample_ray(raster, {}).is_none());
    EXPECT_EQ(camera->connect({0, 0, -1}, {}).importance, 0);
    EXPECT_EQ(camera->connect({1, 0, -0.01f}, {}).importance, 0);
    EXPECT_GT(camera->connect({1, 0, 0.01f}, {}).importance, 0);
    EXPECT_EQ(camera->connect({0, 0, 0}, {}).importance, 0);
  }
  // Behind the camera, too, if it is asked for.
  EXPECT_GT(wide_camera(fisheye("equidistant", 300))->connect({1, 0, -1}, {}).importance, 0);
}

TEST(Fisheye, RefusesWhatAMappingCannotShow) {
  const auto refused = [](const std::string& mapping, double fov) {
    expect_problem("<sensor type=\"fisheye\"><string name=\"mapping\" value=\"" + mapping +
                       "\"/>\n<float name=\"fov\" value=\"" + std::to_string(fov) +
                       "\"/></sensor>" + any_shape,
                   "3:1", "cannot show", "equidistant");
  };
  refused("hemispherical", 200);
  refused("stereographic", 360);
}

// By the formula of Mitsuba 0.6: d = (sin φ sin θ, cos θ, −cos φ sin θ), φ = 2πx/w, θ = πy/h.
TEST(Spherical, IsTurnedAsMitsubas) {
  const auto camera = camera_of("spherical", {}, film_of(64, 32));
  for (uint32_t i = 0; i < 100; ++i) {
    Sampler sampler(4, i);
    const Vec2f u = sampler.next_2d();
    const double phi = 2 * std::numbers::pi * double(u.x), theta = std::numbers::pi * double(u.y);
    const Vec3d expected(std::sin(phi) * std::sin(theta), std::cos(theta),
                         -std::cos(phi) * std::sin(theta));
    const Vec3f direction = camera->sample_ray({64 * u.x, 32 * u.y}, {}).direction;
    EXPECT_LT((Vec3d(direction) - expected).length(), 2e-6);
  }
}

// Beyond the edges, where filters reach, rays go on around; what they see there is shown there.
TEST(Panorama, GoesOnBeyondItsEdges) {
  for (const char* type : {"spherical", "cylinder"})
    for (const bool is_cropped : {false, true}) {
      SCOPED_TRACE(type);
      FilmSettings film = film_of(12, 6);
      film.filter = gaussian_filter(0.5f, 2.0f);
      if (is_cropped) film.crop_size = {5, 6};
      const auto camera = camera_of(type, {}, film);
      EXPECT_TRUE(camera->traits().repeats);
      const float reach = 1.4f;
      const auto right = float(film.crop_size.x) + reach;
      int repeated = 0;
      for (uint32_t i = 0; i < 400; ++i) {
        Sampler sampler(9, i);
        const Vec2f u = sampler.next_2d();
        const Vec2f raster(-reach + u.x * (right + reach), -reach + u.y * (6 + 2 * reach));
        const CameraRay ray = camera->sample_ray(raster, {});
        const CameraConnection seen = camera->connect(ray.origin + ray.direction * 3.0f, {});
        EXPECT_GT(seen.importance, 0);
        std::vector<Vec2f> rasters = {seen.raster};
        camera->visit_repetitions(seen, [&](const CameraConnection& other) {
          EXPECT_EQ(other.importance, seen.importance);
          rasters.push_back(other.raster);
          ++repeated;
        });
        // All show the same, and its own is among them.
        float nearest = infinity;
        for (const Vec2f& other : rasters) {
          EXPECT_LT(length(camera->sample_ray(other, {}).direction - ray.direction), 1e-4f);
          nearest = std::min(nearest, (other - raster).length());
        }
        EXPECT_LT(nearest, 0.01f) << raster.x << ", " << raster.y;
      }
      // Of a cylinder that is cropped on the right no column comes twice.
      const bool is_all_there = !is_cropped || type == std::string("spherical");
      if (is_all_there)
        EXPECT_GT(repeated, 40);
      else
        EXPECT_EQ(repeated, 0);
    }
}

TEST(WideCamera, ReportsSayWhatIsSeen) {
  for (const WideView& view : wide_views()) {
    const auto camera = wide_camera(view);
    EXPECT_FALSE(camera->traits().view.empty());
    EXPECT_EQ(camera->traits().horizontal_fov, 0);
    EXPECT_GT(camera->traits().pixel_spread, 0);
  }
}

}  // namespace
}  // namespace kaustik
