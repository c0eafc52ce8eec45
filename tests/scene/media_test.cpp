// Media in scenes: who refers to what, what is found out, and every way to get it wrong.

#include "tests/scene/scene_support.h"

namespace kaustik {
namespace {

using namespace test;

const std::string media_camera = any_camera;
const std::string media_sphere = any_shape;

std::string medium(const std::string& inside) {
  return "<medium name=\"interior\" type=\"homogeneous\">" + inside + "</medium>";
}
std::string color(const std::string& name, const std::string& value) {
  return "<rgb name=\"" + name + "\" value=\"" + value + "\"/>";
}
std::string with_medium(const std::string& inside) {
  return media_camera + "<shape type=\"sphere\">" + medium(inside) + "</shape>";
}
const Medium& interior_of(const Scene& scene) { return *scene.surface(0).interior; }

/// Farther away than the camera's position in the origin.
const std::string away = "<point name=\"center\" value=\"0, 0, 9\"/>";

TEST(Media, DefaultsAreMitsubas) {
  const auto scene = scene_of(with_medium(""));
  EXPECT_EQ(interior_of(*scene).extinction({}, {}), Spectrum(1));
  EXPECT_EQ(interior_of(*scene).scattering({}, {}), Spectrum(0.75f));
  EXPECT_EQ(interior_of(*scene).phase().mean_cosine(), 0);
  EXPECT_EQ(scene->surface(0).exterior, nullptr);
  EXPECT_TRUE(scene->has_media());
  EXPECT_TRUE(scene->has_scattering());
}

TEST(Media, SceneWithoutAnyHasNone) {
  EXPECT_FALSE(scene_of(media_camera + media_sphere)->has_media());
  EXPECT_TRUE(
      scene_of(media_camera + "<shape type=\"sphere\"><bsdf type=\"null\"/></shape>")->has_media());
}

TEST(Media, CoefficientsByAlbedoOrByParts) {
  const auto a = scene_of(with_medium(color("sigma_t", "1, 2, 4") + color("albedo", "0.5, 0, 1") +
                                      "<float name=\"scale\" value=\"10\"/>"));
  const auto b = scene_of(with_medium(color("sigma_a", "5, 20, 0") + color("sigma_s", "5, 0, 40")));
  for (int lane = 0; lane < 3; ++lane) {
    EXPECT_FLOAT_EQ(interior_of(*a).extinction({}, {})[lane],
                    interior_of(*b).extinction({}, {})[lane]);
    EXPECT_FLOAT_EQ(interior_of(*a).scattering({}, {})[lane],
                    interior_of(*b).scattering({}, {})[lane]);
  }
  EXPECT_FLOAT_EQ(interior_of(*a).extinction({}, {})[2], 40);
}

TEST(Media, AreSharedByReference) {
  const auto scene = scene_of(
      "<medium type=\"homogeneous\" id=\"haze\"><phase type=\"hg\"><float name=\"g\" "
      "value=\"0.3\"/></phase></medium>"
      "<sensor type=\"perspective\"><ref id=\"haze\"/></sensor>"
      "<shape type=\"sphere\">" +
      away + "<ref name=\"exterior\" id=\"haze\"/></shape>");
  EXPECT_EQ(scene->surface(0).exterior.get(), scene->camera_medium());
  EXPECT_FLOAT_EQ(scene->camera_medium()->phase().mean_cosine(), 0.3f);
  EXPECT_TRUE(scene->warnings().empty());
}

/// What a lamp shines into follows from the boundaries around it.
TEST(Media, OfLampsAreFoundOut) {
  const auto scene = scene_of(
      media_camera + "<shape type=\"sphere\">" + away + "<bsdf type=\"null\"/>" + medium("") +
      "</shape>"
      "<emitter type=\"point\"><point name=\"position\" value=\"0, 0, 9.5\"/></emitter>"
      "<emitter type=\"point\"><point name=\"position\" value=\"0, 0, 5\"/></emitter>"
      "<emitter type=\"constant\"/>"
      "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"0.1\"/><translate "
      "value=\"0, 0, 9\"/></transform><emitter type=\"area\"/></shape>");
  const Medium* inside = scene->surface(0).interior.get();
  EXPECT_EQ(scene->light_medium(0), inside);
  EXPECT_EQ(scene->light_medium(1), nullptr);
  EXPECT_EQ(scene->light_medium(2), nullptr);
  EXPECT_EQ(scene->light_medium(3), inside);
}

/// What neither absorbs nor scatters costs nothing, and is not what lies around it.
TEST(Media, WithoutExtinctionAreVacuum) {
  const std::string clear =
      R"(<medium name="interior" type="homogeneous"><rgb name="sigma_t" value="0, 0, 0"/></medium>)";
  const auto clear_scene =
      scene_of(media_camera + "<shape type=\"sphere\">" + away + clear + "</shape>");
  EXPECT_FALSE(clear_scene->has_media());
  const auto scene =
      scene_of("<sensor type=\"perspective\">" + std::string("<medium type=\"homogeneous\"/>") +
               "</sensor><shape type=\"sphere\">" + away + "<bsdf type=\"dielectric\"/>" + clear +
               "</shape>");
  EXPECT_TRUE(scene->has_media());
  EXPECT_TRUE(scene->surface(0).separates_media());
  EXPECT_EQ(scene->surface(0).medium_toward(false, scene->camera_medium()), nullptr);
}

/// In a medium without an end everything lies in it.
TEST(Media, WithoutABoundaryAreEverywhere) {
  const auto scene =
      scene_of("<sensor type=\"perspective\">" + std::string("<medium type=\"homogeneous\"/>") +
               "</sensor><shape type=\"sphere\">" + away +
               "</shape><emitter type=\"point\"/>"
               "<emitter type=\"constant\"/>");
  EXPECT_EQ(scene->light_medium(0), scene->camera_medium());
  EXPECT_EQ(scene->light_medium(1), scene->camera_medium());
}

TEST(Media, ACameraInAMediumThatItDoesNotNameIsTold) {
  const auto scene = scene_of(media_camera + "<shape type=\"sphere\">" + "<bsdf type=\"null\"/>" +
                              medium("") + "</shape>");
  ASSERT_EQ(scene->warnings().size(), 1u);
  EXPECT_NE(scene->warnings()[0].find("256 of 256 rays"), std::string::npos)
      << scene->warnings()[0];
  EXPECT_NE(scene->warnings()[0].find("sensor"), std::string::npos);
}

/// A boundary that is open on the camera's side: rays come in without having passed it.
TEST(Media, AHoleInABoundaryIsTold) {
  const auto scene = scene_of(media_camera +
                              "<shape type=\"rectangle\"><transform name=\"to_world\">"
                              "<scale value=\"20\"/><translate value=\"0, 0, 9\"/></transform>"
                              "<bsdf type=\"null\"/><ref name=\"interior\" id=\"m\"/>"
                              "<ref name=\"exterior\" id=\"n\"/></shape>"
                              "<medium type=\"homogeneous\" id=\"m\"/>"
                              "<medium type=\"homogeneous\" id=\"n\"/>");
  ASSERT_EQ(scene->warnings().size(), 1u);
  EXPECT_NE(scene->warnings()[0].find("not closed"), std::string::npos) << scene->warnings()[0];
}

TEST(MediaErrors, OfCoefficients) {
  const auto problem = [](const std::string& inside, const std::string& message) {
    const std::vector<Problem> problems = problems_of(with_medium(inside));
    EXPECT_EQ(problems.size(), 1u);
    EXPECT_NE(problems[0].message.find(message), std::string::npos) << problems[0].message;
    EXPECT_FALSE(problems[0].remedy.empty()) << problems[0].message;
    EXPECT_GT(problems[0].place.line, 0);
  };
  problem(color("sigma_t", "-1, 1, 1"), "sigma_t");
  problem(color("albedo", "1.01, 0, 0"), "albedo");
  problem(color("albedo", "0, -0.5, 0"), "albedo");
  problem(color("sigma_a", "1, 1, 1") + color("sigma_t", "1, 1, 1"), "described twice");
  problem(color("sigma_s", "1, -1, 1"), "sigma_s");
  problem("<float name=\"scale\" value=\"-1\"/>", "scale");
  problem(color("sigma_t", "1e30, 1, 1") + "<float name=\"scale\" value=\"1e20\"/>", "too large");
  for (const std::string g : {"1", "-1"})
    problem("<phase type=\"hg\"><float name=\"g\" value=\"" + g + "\"/></phase>",
            "scatters nowhere");
  problem("<phase type=\"hg\"><float name=\"g\" value=\"1.5\"/></phase>", "'g'");
  problem("<phase type=\"mie\"/>", "unknown phase type 'mie'");
  problem("<phase type=\"hg\"/><phase type=\"isotropic\"/>", "second phase");
  problem("<bsdf type=\"diffuse\"/>", "cannot hold a bsdf");
}

TEST(MediaErrors, OfNumbersThatAreNone) {
  for (const std::string value : {"nan, 1, 1", "inf, 1, 1", "1, 1"})
    EXPECT_THROW(scene_of(with_medium(color("sigma_t", value))), Error) << value;
}

TEST(MediaErrors, OfReferences) {
  const auto message_of = [](const std::string& objects) {
    return problems_of(objects)[0].message;
  };
  EXPECT_EQ(message_of(media_camera + "<medium type=\"fog\"/>" + media_sphere),
            "unknown medium type 'fog'");
  EXPECT_NE(
      message_of(media_camera + "<shape type=\"sphere\"><medium type=\"homogeneous\"/></shape>")
          .find("on which side"),
      std::string::npos);
  EXPECT_NE(message_of("<sensor type=\"perspective\"><medium type=\"homogeneous\"/><medium "
                       "type=\"homogeneous\"/></sensor>" +
                       media_sphere)
                .find("second medium"),
            std::string::npos);
  EXPECT_NE(message_of(media_camera + "<shape type=\"sphere\"><bsdf type=\"twosided\"><bsdf "
                                      "type=\"null\"/></bsdf></shape>")
                .find("transmits"),
            std::string::npos);
}

}  // namespace
}  // namespace kaustik
