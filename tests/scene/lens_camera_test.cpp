// The thin lens: what it promises, and that these tests would find it broken.

#include "kaustik/base/statistics.h"
#include "tests/scene/camera_support.h"

namespace kaustik {
namespace {

using namespace test;

constexpr double aperture_radius = 0.2, focus_distance = 3;

std::unique_ptr<Camera> lens_camera(int blades, double focus = focus_distance,
                                    double radius = aperture_radius) {
  return camera_of("thinlens", {{"aperture_radius", Value(radius), {}},
                                {"focus_distance", Value(focus), {}},
                                {"blades", Value(int64_t(blades)), {}},
                                {"fov", Value(60.0), {}}});
}

/// How far a camera is from what it should be, worst of many rays.
struct LensErrors {
  double blur = 0;        ///< between where rays meet the sharp plane and where a pinhole's do, m
  double off_middle = 0;  ///< of the mean of where rays begin, m
  double spread = 0;      ///< of the mean square along x and along y, relative
  double beyond = 0;      ///< how far outside of the aperture rays begin, m
  double raster = 0;      ///< between where a point on a ray is seen and whose ray it is, pixels
  double importance = 0;  ///< relative

  bool all_small() const {
    return blur < 1e-5 && off_middle < 2e-4 && spread < 5e-3 && beyond < 1e-6 && raster < 1e-3 &&
           importance < 2e-3;
  }
};

LensErrors errors_of(const Camera& camera, int blades) {
  const std::unique_ptr<Camera> pinhole = camera_of("perspective", {{"fov", Value(60.0), {}}});
  const auto on_sharp_plane = [](const Ray& ray) {
    return Vec3d(ray.origin) + Vec3d(ray.direction) * ((focus_distance - double(ray.origin.z)) /
                                                       double(ray.direction.z));
  };
  LensErrors errors;
  const auto note = [](double& worst, double error) { worst = std::max(worst, std::fabs(error)); };
  RunningStatistics x, y;
  for (uint32_t i = 0; i < 16384; ++i) {
    Sampler sampler(5, i);
    const LensNumbers lens = camera.lens_numbers(sampler);
    const Vec2f raster = Vec2f(1, 1) + sampler.next_2d() * Vec2f(30, 22);
    const CameraRay ray = camera.sample_ray(raster, lens);
    x.add(double(ray.origin.x));
    y.add(double(ray.origin.y));
    note(errors.beyond, std::max(0.0, double(length(ray.origin)) - aperture_radius));
    note(errors.blur,
         (on_sharp_plane(ray) - on_sharp_plane(pinhole->sample_ray(raster, {}))).length());
    const Vec2f seen = camera.connect(ray.origin + ray.direction * 5.0f, lens).raster;
    note(errors.raster, double((seen - raster).length()));
    if (i % 64 == 0) note(errors.importance, importance_error(camera, raster, lens));
  }
  note(errors.off_middle, std::hypot(x.mean(), y.mean()));
  // The mean square of a coordinate: R²/4 of a disk, less of a regular polygon in it:
  // R²/12 (2 + cos(2π/n)).
  const double expected = aperture_radius * aperture_radius *
                          (blades == 0 ? 0.25 : (2 + std::cos(2 * std::numbers::pi / blades)) / 12);
  note(errors.spread, x.variance() / expected - 1);
  note(errors.spread, y.variance() / expected - 1);
  return errors;
}

/// Rays of one camera, connections of another, both shifted, the importance by a factor.
class SpoiledCamera final : public Camera {
 public:
  SpoiledCamera(const Camera& rays, const Camera& connections, const Vec3f& shift, float factor)
      : rays_(rays), connections_(connections), shift_(shift), factor_(factor) {
    traits_ = rays.traits();
  }
  CameraRay sample_ray(const Vec2f& raster, const LensNumbers& lens) const override {
    CameraRay ray = rays_.sample_ray(raster, lens);
    ray.origin += shift_;
    return ray;
  }
  CameraConnection connect(const Vec3f& point, const LensNumbers& lens) const override {
    CameraConnection c = connections_.connect(point - shift_, lens);
    c.lens += shift_;
    c.importance *= factor_;
    return c;
  }

 private:
  const Camera& rays_;
  const Camera& connections_;
  Vec3f shift_;
  float factor_;
};

TEST(LensCamera, IsWhatItPromises) {
  for (const int blades : {0, 3, 6}) {
    const auto camera = lens_camera(blades);
    EXPECT_TRUE(camera->traits().has_lens);
    const LensErrors e = errors_of(*camera, blades);
    EXPECT_TRUE(e.all_small()) << blades << " blades: blur " << e.blur << ", off the middle "
                               << e.off_middle << ", spread " << e.spread << ", beyond " << e.beyond
                               << ", raster " << e.raster << ", importance " << e.importance;
  }
  // Without an aperture it is a pinhole.
  EXPECT_FALSE(lens_camera(0, focus_distance, 0)->traits().has_lens);
}

// Twins with planted errors: each must be found.
TEST(LensCamera, AWrongLensWouldBeFound) {
  const auto right = lens_camera(0), unsharp = lens_camera(0, 1.005 * focus_distance),
             wide = lens_camera(0, focus_distance, 1.005 * aperture_radius),
             angular = lens_camera(6);
  const auto is_found = [](const Camera& rays, const Camera& connections, const Vec3f& shift,
                           float factor) {
    return !errors_of(SpoiledCamera(rays, connections, shift, factor), 0).all_small();
  };
  EXPECT_FALSE(is_found(*right, *right, {0, 0, 0}, 1));
  EXPECT_TRUE(is_found(*unsharp, *unsharp, {0, 0, 0}, 1)) << "focus off by 0.5 %";
  EXPECT_TRUE(is_found(*right, *unsharp, {0, 0, 0}, 1)) << "of connections alone";
  EXPECT_TRUE(is_found(*unsharp, *right, {0, 0, 0}, 1)) << "of rays alone";
  EXPECT_TRUE(is_found(*right, *right, {0.001f, 0, 0}, 1)) << "lens off by 0.5 % of its radius";
  EXPECT_TRUE(is_found(*wide, *wide, {0, 0, 0}, 1)) << "radius off by 0.5 %";
  EXPECT_TRUE(is_found(*right, *wide, {0, 0, 0}, 1)) << "of connections alone";
  EXPECT_TRUE(is_found(*right, *right, {0, 0, 0}, 1.005f)) << "importance off by 0.5 %";
  EXPECT_TRUE(is_found(*angular, *angular, {0, 0, 0}, 1)) << "blades in place of a disk";
}

/// The worst importance of a telecentric camera, relatively, at many rays.
double telecentric_error(const Camera& camera) {
  double worst = 0;
  for (uint32_t i = 0; i < 256; ++i) {
    Sampler sampler(9, i);
    const LensNumbers lens = camera.lens_numbers(sampler);
    const Vec2f raster = Vec2f(1, 1) + sampler.next_2d() * Vec2f(30, 22);
    worst = std::max(worst, std::fabs(importance_error(camera, raster, lens)));
  }
  return worst;
}

// Rays that lean see a pixel's area aslant: without the cosine, 10 % here, it would be found.
TEST(LensCamera, ImportanceOfTelecentricCameras) {
  const auto camera = [](double radius) {
    return camera_of("telecentric", {{"aperture_radius", Value(radius), {}},
                                     {"focus_distance", Value(focus_distance), {}}});
  };
  const auto wide = camera(1.5), closed = camera(0);
  EXPECT_LT(telecentric_error(*wide), 1e-3);
  EXPECT_LT(telecentric_error(*closed), 1e-3);
  EXPECT_GT(telecentric_error(SpoiledCamera(*wide, *wide, {0, 0, 0}, 1.005f)), 4e-3);
  EXPECT_GT(telecentric_error(SpoiledCamera(*wide, *closed, {0, 0, 0}, 1)), 0.05);
}

TEST(LensCamera, NeedsAnApertureOfSomeArea) {
  EXPECT_THROW(camera_of("thinlens", {}), Error);
  EXPECT_THROW(camera_of("thinlens",
                         {{"aperture_radius", Value(0.1), {}}, {"blades", Value(int64_t(2)), {}}}),
               Error);
}

}  // namespace
}  // namespace kaustik
