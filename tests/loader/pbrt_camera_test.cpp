// pbrt's cameras, films, filters, samplers and integrators.

#include <cmath>
#include <numbers>

#include "kaustik/loader/pbrt/camera.h"
#include "tests/loader/pbrt_support.h"

namespace kaustik::pbrt {
namespace {

Object camera_in(const std::string& lines) {
  return only(parse_scene_of_pbrt(lines + "\nWorldBegin"), "sensor");
}

TEST(PbrtCamera, SamplersHaveTheirUsualNumbers) {
  for (const auto& [sampler, count] : {std::pair<std::string, int64_t>("", 16),
                                       {"Sampler \"independent\"", 4},
                                       {"Sampler \"halton\"", 16},
                                       {"Sampler \"stratified\" \"integer xsamples\" 3", 12}}) {
    const Description scene = parse_scene_of_pbrt(sampler + " WorldBegin");
    EXPECT_EQ(value<int64_t>(only(only(scene, "sensor"), "sampler"), "sample_count"), count)
        << sampler;
  }
}

TEST(PbrtCamera, ExposuresAreToldAndBounded) {
  const auto film_of = [](const Description& scene) { return only(only(scene, "sensor"), "film"); };
  const Description usual = parse_scene_of_pbrt("Film \"rgb\" \"float iso\" 250 WorldBegin");
  EXPECT_EQ(value<double>(film_of(usual), "iso"), 250);
  EXPECT_TRUE(is_approximated(usual, "film", "exposed 2.5 times"));
  const Description bright = parse_scene_of_pbrt("Film \"rgb\" \"float iso\" 1e12 WorldBegin");
  EXPECT_EQ(value<double>(film_of(bright), "iso"), 1e8);
  EXPECT_TRUE(is_approximated(bright, "film", "not 1e+10 times"));
  const Description closed =
      parse_scene_of_pbrt("Camera \"perspective\" \"float shutterclose\" 0 WorldBegin");
  EXPECT_TRUE(is_approximated(closed, "camera", "never opens"));
}

TEST(PbrtCamera, RegularisingIsTold) {
  EXPECT_TRUE(
      is_ignored(parse_scene_of_pbrt("Integrator \"path\" \"bool regularize\" true WorldBegin"),
                 "integrator", "'regularize' has no effect"));
}

TEST(PbrtCamera, PerspectiveLooksAlongZWithXToTheRight) {
  const Object camera =
      camera_in("LookAt 0 0 5 0 0 0 0 1 0 Camera \"perspective\" \"float fov\" 40");
  EXPECT_EQ(camera.type, "perspective");
  EXPECT_EQ(value<double>(camera, "fov"), 40);
  EXPECT_EQ(value<std::string>(camera, "fov_axis"), "smaller");
  const Transform t = value<Transform>(camera, "to_world");
  EXPECT_NEAR(t.point({0, 0, 0}).z, 5, 1e-6);
  EXPECT_NEAR(t.vector({0, 0, 1}).z, -1, 1e-6);
  // pbrt's spaces are left-handed: +x of the world is on the left when one looks along −z.
  // Kaustik's +x of the camera is to the left.
  EXPECT_NEAR(t.vector({1, 0, 0}).x, 1, 1e-6);
  // Exports mirror x: then +x of the world is on the right.
  const Transform mirrored = value<Transform>(
      camera_in("Scale -1 1 1 LookAt 0 0 5 0 0 0 0 1 0 Camera \"perspective\""), "to_world");
  EXPECT_NEAR(mirrored.vector({1, 0, 0}).x, -1, 1e-6);
}

TEST(PbrtCamera, LensAndWindow) {
  const Object lens = camera_in(
      "Camera \"perspective\" \"float lensradius\" .1 \"float focaldistance\" 4 \"float fov\" 90");
  EXPECT_EQ(lens.type, "thinlens");
  EXPECT_EQ(value<double>(lens, "aperture_radius"), .1);
  EXPECT_EQ(value<double>(lens, "focus_distance"), 4);
  EXPECT_NEAR(
      value<double>(camera_in("Scale .5 .5 .5 Camera \"perspective\" \"float lensradius\" .1"),
                    "aperture_radius"),
      .2, 1e-9);
  const Object shifted = camera_in(
      "Film \"rgb\" \"integer xresolution\" 200 \"integer yresolution\" 100 "
      "Camera \"perspective\" \"float fov\" 90 \"float screenwindow\" [-1 3 -.5 1.5]");
  EXPECT_EQ(value<std::string>(shifted, "fov_axis"), "x");
  EXPECT_NEAR(std::tan(value<double>(shifted, "fov") * std::numbers::pi / 360), 2, 1e-9);
  EXPECT_NEAR(value<double>(shifted, "principal_point_offset_x"), .25, 1e-9);
  EXPECT_NEAR(value<double>(shifted, "principal_point_offset_y"), -.25, 1e-9);
}

TEST(PbrtCamera, OrthographicShowsItsWindow) {
  const Object wide = camera_in(
      "Camera \"orthographic\" Film \"rgb\" \"integer xresolution\" 300 \"integer yresolution\" "
      "100");
  EXPECT_EQ(wide.type, "orthographic");
  expect_same(value<Transform>(wide, "to_world"), Transform::scale({-3, 3, 1}));
  const Object part = camera_in(
      "Camera \"orthographic\" \"float screenwindow\" [0 4 0 2] \"float lensradius\" .5 "
      "Film \"rgb\" \"integer xresolution\" 200 \"integer yresolution\" 100");
  EXPECT_EQ(part.type, "telecentric");
  // Its middle is 2 to the right and 1 above; x of the camera goes to the left.
  expect_same(value<Transform>(part, "to_world"),
              Transform::translate({2, 1, 0}) * Transform::scale({-2, 2, 1}));
}

TEST(PbrtCamera, SphericalLooksBackAlongX) {
  const Transform t = value<Transform>(
      camera_in("Camera \"spherical\" \"string mapping\" \"equirectangular\""), "to_world");
  EXPECT_NEAR(t.vector({0, 0, 1}).x, -1, 1e-6);
  EXPECT_NEAR(t.vector({0, 1, 0}).y, 1, 1e-6);
  EXPECT_NEAR(t.vector({1, 0, 0}).z, 1, 1e-6);  // in the left half
  EXPECT_TRUE(is_approximated(parse_scene_of_pbrt("Camera \"spherical\" WorldBegin"), "camera",
                              "equal area"));
}

TEST(PbrtCamera, LensesOfSurfacesAreThinOnes) {
  // A plano-convex lens of radius 50 mm and index 1.5: f = r / (n − 1).
  const auto lens = pbrt::thin_lens_of({50, 0, 1.5, 20, 0, 0, 1, 10, 1e9, 100, 1, 20});
  ASSERT_TRUE(lens);
  EXPECT_NEAR(lens->focal_length, .1, 1e-6);
  EXPECT_NEAR(lens->aperture, .01, 1e-9);
  EXPECT_FALSE(pbrt::thin_lens_of({1, 2, 3}));
  const TemporaryFolder folder;
  folder.write("lens.dat", "# a lens\n50 0 1.5 20\n0 0 1 10\n1e9 100 1 20\n");
  const Description scene = parse_scene_of_pbrt(
      "Camera \"realistic\" \"string lensfile\" \"lens.dat\" \"float aperturediameter\" 5 "
      "\"float focusdistance\" 2 Film \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" "
      "100 WorldBegin",
      false, folder / "");
  const Object& camera = only(scene, "sensor");
  EXPECT_EQ(camera.type, "thinlens");
  EXPECT_NEAR(value<double>(camera, "aperture_radius"), .0025, 1e-9);
  EXPECT_EQ(value<double>(camera, "focus_distance"), 2);
  EXPECT_TRUE(is_approximated(scene, "camera", "100 mm"));
}

TEST(PbrtFilm, TheLobesOfAFilterHaveBounds) {
  for (const auto& [tau, lobes] : {std::pair{"1e30", 10}, {"-1e30", 1}, {"4.4", 4}}) {
    const Description scene =
        parse_scene_of_pbrt("PixelFilter \"sinc\" \"float tau\" " + std::string(tau) +
                            " Camera \"perspective\" WorldBegin");
    const Object& film = only(only(scene, "sensor"), "film");
    EXPECT_EQ(value<int64_t>(only(film, "rfilter"), "lobes"), lobes);
  }
}

TEST(PbrtFilm, SizeCropExposureFilterSamples) {
  const Description scene = parse_scene_of_pbrt(
      "Film \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" 50 \"float cropwindow\" "
      "[.25 .75 0 .5] \"float iso\" 400 \"string filename\" \"a.exr\" \"string sensor\" \"canon\"\n"
      "Camera \"perspective\" \"float shutteropen\" 0 \"float shutterclose\" .5\n"
      "PixelFilter \"triangle\" \"float xradius\" 1.5 \"float yradius\" 1.5\n"
      "Sampler \"zsobol\" \"integer pixelsamples\" 77 WorldBegin");
  const Object& camera = only(scene, "sensor");
  const Object& film = only(camera, "film");
  EXPECT_EQ(value<int64_t>(film, "width"), 100);
  EXPECT_EQ(value<int64_t>(film, "crop_offset_x"), 25);
  EXPECT_EQ(value<int64_t>(film, "crop_width"), 50);
  EXPECT_EQ(value<int64_t>(film, "crop_offset_y"), 0);
  EXPECT_EQ(value<int64_t>(film, "crop_height"), 25);
  EXPECT_EQ(value<double>(film, "iso"), 200);
  EXPECT_EQ(only(film, "rfilter").type, "tent");
  EXPECT_EQ(value<double>(only(film, "rfilter"), "radius"), 1.5);
  EXPECT_EQ(value<int64_t>(only(camera, "sampler"), "sample_count"), 77);
  EXPECT_TRUE(is_approximated(scene, "film", "canon"));
  const Description bounds =
      parse_scene_of_pbrt("Film \"rgb\" \"integer pixelbounds\" [10 20 30 60] WorldBegin");
  EXPECT_EQ(value<int64_t>(only(only(bounds, "sensor"), "film"), "crop_height"), 30);
  EXPECT_EQ(only(only(only(bounds, "sensor"), "film"), "rfilter").type, "gaussian");
}

TEST(PbrtFilm, Integrators) {
  const auto depth = [](const std::string& line) {
    const Description scene = parse_scene_of_pbrt(line + " WorldBegin");
    EXPECT_EQ(only(scene, "integrator").type, "auto");
    return value<int64_t>(only(scene, "integrator"), "max_depth");
  };
  EXPECT_EQ(depth(""), 6);
  EXPECT_EQ(depth("Integrator \"path\" \"integer maxdepth\" 12"), 13);
  EXPECT_EQ(depth("Integrator \"sppm\" \"float radius\" .1"), 6);
  EXPECT_TRUE(is_approximated(parse_scene_of_pbrt("Integrator \"ambientocclusion\" WorldBegin"),
                              "integrator", "all light"));
  EXPECT_TRUE(is_ignored(parse_scene_of_pbrt("Option \"forcediffuse\" true WorldBegin"), "option",
                         "no effect"));
}

}  // namespace
}  // namespace kaustik::pbrt
