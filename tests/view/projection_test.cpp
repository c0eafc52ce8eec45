// How pages project points of the scene onto the picture.

#include "kaustik/view/projection.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>

#include "kaustik/loader/mitsuba_xml.h"
#include "kaustik/scene/scene.h"

namespace kaustik::view {
namespace {

std::shared_ptr<const Scene> scene_seen_by(const std::string& type, const std::string& more,
                                           const std::string& scale = "") {
  return build_scene(parse_mitsuba_xml(
      "<scene version=\"3.0.0\"><sensor type=\"" + type + "\">" + more +
          "<transform name=\"to_world\">" + scale +
          "<lookat origin=\"3,-4,2\" target=\"0.5,0.2,0.5\" up=\"0,0,1\"/></transform>"
          "<film type=\"hdrfilm\"><integer name=\"width\" value=\"60\"/><integer name=\"height\" "
          "value=\"40\"/><integer name=\"crop_offset_x\" value=\"5\"/><integer "
          "name=\"crop_offset_y\" value=\"10\"/><integer name=\"crop_width\" value=\"48\"/>"
          "<integer name=\"crop_height\" value=\"25\"/></film></sensor>"
          "<shape type=\"sphere\"/><emitter type=\"constant\"/></scene>",
      "test.xml", ""));
}

struct Seen {
  double x, y, w;
};
Seen seen_by(const Projection& m, const Vec3f& p) {
  const auto row = [&](size_t i) {
    return m[i] * double(p.x) + m[i + 1] * double(p.y) + m[i + 2] * double(p.z) + m[i + 3];
  };
  const double w = row(8);
  return {row(0) / w, row(4) / w, w};
}

/// The largest distance, in pixels, between where the matrix says that points are seen and where
/// the camera does; infinite if one is behind it.
double largest_error(const Camera& camera, const Projection& projection) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<float> place(-1, 1);
  double largest = 0;
  int count = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3f point(place(generator), place(generator), place(generator));
    const CameraConnection connection = camera.connect(point, Camera::middle_of_lens());
    if (connection.importance == 0) continue;
    ++count;
    const Seen seen = seen_by(projection, point);
    if (!(seen.w > 0)) return infinity;
    largest = std::max(largest, std::hypot(seen.x - double(connection.raster.x),
                                           seen.y - double(connection.raster.y)));
  }
  EXPECT_GT(count, 100);
  return largest;
}

TEST(Projection, IsWhatTheCameraSees) {
  const std::string wide = "<float name=\"fov\" value=\"40\"/>";
  for (const auto& [type, more, scale] : std::vector<std::array<std::string, 3>>{
           {"perspective", wide, ""},
           {"perspective", wide + "<string name=\"fov_axis\" value=\"y\"/>", ""},
           {"perspective",
            wide + "<float name=\"principal_point_offset_x\" value=\"0.2\"/>"
                   "<float name=\"principal_point_offset_y\" value=\"-0.1\"/>",
            ""},
           {"perspective", "<float name=\"fov\" value=\"110\"/>", "<scale x=\"-1\"/>"},
           {"thinlens",
            wide + "<float name=\"aperture_radius\" value=\"0.1\"/><float "
                   "name=\"focus_distance\" value=\"4\"/>",
            ""},
           {"orthographic", "", "<scale x=\"2\" y=\"2\"/>"}}) {
    const auto scene = scene_seen_by(type, more, scale);
    const auto projection = projection_of(scene->camera(), scene->film().size);
    ASSERT_TRUE(projection) << type << more;
    EXPECT_LT(largest_error(scene->camera(), *projection), 0.02) << type << more;
    // A picture that is one pixel larger is noticed.
    const auto other = projection_of(scene->camera(), scene->film().size);
    Projection wrong = *other;
    for (size_t i = 0; i < 4; ++i) wrong[i] *= 1.01;
    EXPECT_GT(largest_error(scene->camera(), wrong), 0.1) << type << more;
  }
}

TEST(Projection, PointsBehindHaveNoPlace) {
  const auto scene = scene_seen_by("perspective", "<float name=\"fov\" value=\"40\"/>");
  const auto projection = projection_of(scene->camera(), scene->film().size);
  ASSERT_TRUE(projection);
  EXPECT_LT(seen_by(*projection, Vec3f(6, -8, 3)).w, 0);
  EXPECT_GT(seen_by(*projection, Vec3f(0, 0, 0)).w, 0);
}

TEST(Projection, OfNarrowViews) {
  const auto scene = scene_seen_by("perspective", "<float name=\"fov\" value=\"0.5\"/>");
  const auto projection = projection_of(scene->camera(), scene->film().size);
  ASSERT_TRUE(projection);
  for (const Vec2f& raster : {Vec2f(3, 4), Vec2f(40, 20)}) {
    const CameraRay ray = scene->camera().sample_ray(raster, Camera::middle_of_lens());
    const Seen seen = seen_by(*projection, ray.origin + ray.direction * 3.0f);
    EXPECT_NEAR(seen.x, double(raster.x), 0.05);
    EXPECT_NEAR(seen.y, double(raster.y), 0.05);
  }
}

TEST(Projection, CurvedViewsHaveNone) {
  for (const char* type : {"fisheye", "spherical", "cylinder", "radiancemeter", "fluencemeter"}) {
    const auto scene = scene_seen_by(type, "");
    EXPECT_FALSE(projection_of(scene->camera(), scene->film().size)) << type;
  }
}

}  // namespace
}  // namespace kaustik::view
