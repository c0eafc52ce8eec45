// Media in scenes: who refers to what, what is found out, and every way to get it wrong.

#include <fstream>

#include "kaustik/medium/medium_presets.h"
#include "tests/scene/scene_support.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/vol_file.h"

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

TEST(Media, SubstancesThatWereMeasured) {
  const auto coefficients_of = [](const std::string& inside, const std::string& version) {
    const auto scene =
        build_scene(parse_mitsuba_xml("<scene version=\"" + version + "\">" + with_medium(inside) +
                                          "<emitter type=\"constant\"/></scene>",
                                      "test.xml", ""));
    return std::pair(interior_of(*scene).extinction({}, {}),
                     interior_of(*scene).scattering({}, {}));
  };
  const auto material = [](const std::string& name) {
    return "<string name=\"material\" value=\"" + name + "\"/>";
  };
  const auto expect_lanes = [](const std::pair<Spectrum, Spectrum>& given, const Rgb& extinction,
                               const Rgb& scattering) {
    const double t[] = {extinction.r, extinction.g, extinction.b};
    const double s[] = {scattering.r, scattering.g, scattering.b};
    for (int lane = 0; lane < 3; ++lane) {
      EXPECT_NEAR(double(given.first[lane]), t[lane], 2e-6 * t[lane]) << lane;
      EXPECT_NEAR(double(given.second[lane]), s[lane], 2e-6 * s[lane]) << lane;
    }
  };
  // Per millimetre; scattering is the reduced coefficient.
  expect_lanes(coefficients_of(material("skimmilk"), "3.0.0"), {0.7014, 1.2225, 1.9142},
               {0.7, 1.22, 1.9});
  expect_lanes(
      coefficients_of(material("lowfat milk") + "<float name=\"scale\" value=\"1000\"/>", "3.0.0"),
      {894.7376, 1519.3110, 2543.4652}, {891.8676, 1513.5610, 2531.9652});
  // Of Mitsuba 0.6, whose names do not tell upper from lower case: a hundred times that. What is
  // missing is skin.
  expect_lanes(coefficients_of(material("Skin1"), "0.6.0"), {77.2, 105, 149}, {74, 88, 101});
  expect_lanes(coefficients_of("", "0.6.0"), {77.2, 105, 149}, {74, 88, 101});
  expect_lanes(coefficients_of(color("sigmaS", "74, 88, 101"), "0.6.0"), {77.2, 105, 149},
               {74, 88, 101});
  expect_lanes(coefficients_of(color("sigmaA", "3.2, 17, 48"), "0.6.0"), {77.2, 105, 149},
               {74, 88, 101});
  expect_lanes(coefficients_of(color("sigmaT", "77.2, 105, 149"), "0.6.0"), {77.2, 105, 149},
               {74, 88, 101});
  // Each of them makes a medium.
  for (const MediumPreset& preset : medium_presets()) {
    std::string name = preset.name;
    if (const size_t at = name.find('&'); at != std::string::npos) name.replace(at, 1, "&amp;");
    const auto [extinction, scattering] = coefficients_of(material(name), "3.0.0");
    for (int lane = 0; lane < 3; ++lane) {
      EXPECT_GT(extinction[lane], 0) << preset.name;
      EXPECT_LE(scattering[lane], extinction[lane]) << preset.name;
    }
  }
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

class GridsInScenes : public testing::Test {
 protected:
  std::string file(const std::string& bytes) {
    const std::string path = folder_.path("grid.vol");
    std::ofstream(path, std::ios::binary) << bytes;
    return "<string name=\"filename\" value=\"" + path + "\"/>";
  }
  static std::string cloud(const std::string& inside) {
    return media_camera + "<shape type=\"sphere\">" + away +
           "<medium name=\"interior\" type=\"heterogeneous\">" + inside + "</medium></shape>";
  }
  static std::string grid(const std::string& name, const std::string& inside) {
    return "<volume name=\"" + name + "\" type=\"gridvolume\">" + inside + "</volume>";
  }
  const std::string two_cells_ = vol_file({2, 1, 1}, {1, 3}, {.box = {0, 0, 8, 4, 1, 10}});
  TemporaryFolder folder_;
};

TEST_F(GridsInScenes, LieWhereTheyArePlaced) {
  const auto scene = scene_of(
      cloud(grid("sigma_t", file(two_cells_) + "<transform name=\"to_world\"><scale value=\"4, 1, "
                                               "2\"/><translate value=\"0, 0, 8\"/></transform>") +
            "<float name=\"scale\" value=\"2\"/><float name=\"albedo\" value=\"0.5\"/>"));
  EXPECT_FLOAT_EQ(interior_of(*scene).extinction({2, 0.5f, 9}, {})[1], 4);
  EXPECT_FLOAT_EQ(interior_of(*scene).scattering({0.5f, 0.5f, 9}, {})[1], 1);
  EXPECT_EQ(interior_of(*scene).extinction({2, 0.5f, 7.9f}, {})[1], 0);
  EXPECT_TRUE(scene->has_scattering());
  // The same by the file's own box, and with another name of the type.
  for (const std::string type : {"gridvolume", "grid"}) {
    const auto by_box =
        scene_of(cloud("<volume name=\"sigma_t\" type=\"" + type + "\">" + file(two_cells_) +
                       "<boolean name=\"use_grid_bbox\" value=\"true\"/></volume>"
                       "<float name=\"scale\" value=\"2\"/>"));
    EXPECT_FLOAT_EQ(interior_of(*by_box).extinction({2, 0.5f, 9}, {})[1], 4);
    EXPECT_EQ(interior_of(*by_box).extinction({2, 0.5f, 7.9f}, {})[1], 0);
  }
}

TEST_F(GridsInScenes, MayBeReferredTo) {
  const auto scene =
      scene_of(cloud("<ref name=\"sigma_t\" id=\"v\"/>"
                     "<volume name=\"albedo\" type=\"constvolume\"><rgb "
                     "name=\"value\" value=\"0.5, 1, 0\"/></volume>") +
               "<volume type=\"gridvolume\" id=\"v\">" + file(two_cells_) + "</volume>");
  EXPECT_FLOAT_EQ(interior_of(*scene).scattering({0.1f, 0.5f, 0.5f}, {})[0], 0.5f);
  EXPECT_FLOAT_EQ(interior_of(*scene).scattering({0.1f, 0.5f, 0.5f}, {})[1], 1);
}

TEST(Media, TakeTheirVolumesFromTheSceneBefore) {
  const Description description =
      description_of(with_medium("<volume name=\"albedo\" type=\"constvolume\"><float "
                                 "name=\"value\" value=\"0.5\"/></volume>"));
  const auto first = build_scene(description);
  EXPECT_EQ(first->build_counts().volumes, 1);
  EXPECT_EQ(build_scene(description, first)->build_counts().volumes, 0);
}

TEST_F(GridsInScenes, DoNotMoveWithInstances) {
  const auto scene = scene_of(
      media_camera + "<shape type=\"shapegroup\" id=\"g\"><shape type=\"sphere\">" + away +
      "<medium name=\"interior\" type=\"heterogeneous\">" + grid("sigma_t", file(two_cells_)) +
      "</medium></shape></shape>"
      "<shape type=\"instance\"><ref id=\"g\"/></shape>");
  ASSERT_FALSE(scene->warnings().empty());
  EXPECT_NE(scene->warnings()[0].find("instances do not move"), std::string::npos)
      << scene->warnings()[0];
}

TEST_F(GridsInScenes, ThatAreNotThereAreEmpty) {
  const auto scene =
      scene_of(cloud(grid("sigma_t", "<string name=\"filename\" value=\"nothing.vol\"/>")));
  ASSERT_FALSE(scene->warnings().empty());
  EXPECT_NE(scene->warnings()[0].find("no file 'nothing.vol': it is 0 everywhere"),
            std::string::npos)
      << scene->warnings()[0];
}

TEST_F(GridsInScenes, SayWhatIsWrong) {
  const auto problem = [](const std::string& text, const std::string& message) {
    const std::vector<Problem> problems = problems_of(text);
    ASSERT_FALSE(problems.empty()) << message;
    EXPECT_NE(problems[0].message.find(message), std::string::npos) << problems[0].message;
    EXPECT_FALSE(problems[0].remedy.empty()) << problems[0].message;
  };
  problem(cloud(grid("sigma_t", file("VOL\x03"))), "header");
  problem(cloud(grid("sigma_t", "")), "filename");
  problem(cloud(grid("albeedo", file(two_cells_))), "takes no volume 'albeedo'");
  problem(cloud(grid("sigma_t", file(vol_file({1, 1, 1}, {-1})))), "density");
  problem(cloud(grid("sigma_t", file(vol_file({1, 1, 1}, {1}, {.box = {0, 0, 0, 1, 0, 1}})) +
                                    "<boolean name=\"use_grid_bbox\" value=\"true\"/>")),
          "box");
  problem(cloud("<volume name=\"sigma_t\" type=\"gridvolum\"/>"),
          "unknown volume type 'gridvolum'");
  problem(with_medium(grid("sigma_t", file(two_cells_))), "homogeneous");
  problem(media_camera + "<volume type=\"constvolum\"/>" + media_sphere,
          "unknown volume type 'constvolum'");
}

TEST(PhaseFunctionsInScenes, NestAndHaveTables) {
  const auto scene = scene_of(with_medium(
      "<phase type=\"blendphase\"><float name=\"weight\" value=\"0.25\"/>"
      "<phase name=\"b\" type=\"hg\"><float name=\"g\" value=\"0.8\"/></phase>"
      "<phase name=\"a\" type=\"tabphase\"><string name=\"values\" value=\"0, 2, 4\"/></phase>"
      "</phase>"));
  EXPECT_NEAR(interior_of(*scene).phase().mean_cosine(), 0.75f / 3 + 0.25f * 0.8f, 1e-6f);
  EXPECT_EQ(scene_of(with_medium("<phase type=\"rayleigh\"/>"))
                ->surface(0)
                .interior->phase()
                .mean_cosine(),
            0);
}

TEST(PhaseFunctionsInScenes, SayWhatIsWrong) {
  const auto problem = [](const std::string& phase, const std::string& message) {
    const std::vector<Problem> problems = problems_of(with_medium(phase));
    ASSERT_FALSE(problems.empty()) << message;
    EXPECT_NE(problems[0].message.find(message), std::string::npos) << problems[0].message;
    EXPECT_FALSE(problems[0].remedy.empty()) << problems[0].message;
  };
  problem("<phase type=\"blendphase\"/>", "holds 0 phase functions");
  problem("<phase type=\"blendphase\"><phase type=\"hg\"/></phase>", "holds 1 phase functions");
  problem("<phase type=\"hg\"><phase type=\"hg\"/></phase>", "cannot hold a phase");
  problem("<phase type=\"tabphase\"/>", "values");
  for (const std::string values : {"1", "0, 0", "1, x", "1, -2", "nan, 1", "1, 2e400", ""})
    problem("<phase type=\"tabphase\"><string name=\"values\" value=\"" + values + "\"/></phase>",
            "tabphase");
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
  const std::string milk = "<string name=\"material\" value=\"wholemilk\"/>";
  problem(milk + color("sigma_s", "1, 1, 1"), "described twice");
  problem(milk + color("albedo", "1, 1, 1"), "described twice");
  problem("<string name=\"material\" value=\"whole milk\"/>", "'material' cannot be 'whole milk'");
  EXPECT_NE(
      problems_of(with_medium("<string name=\"material\" value=\"whole milk\"/>"))[0].remedy.find(
          "did you mean 'wholemilk'?"),
      std::string::npos);
  problem("<float name=\"scale\" value=\"-1\"/>", "scale");
  problem(color("sigma_t", "1e30, 1, 1") + "<float name=\"scale\" value=\"1e20\"/>", "too large");
  for (const std::string g : {"1", "-1"})
    problem("<phase type=\"hg\"><float name=\"g\" value=\"" + g + "\"/></phase>",
            "scatters nowhere");
  problem("<phase type=\"hg\"><float name=\"g\" value=\"1.5\"/></phase>", "'g'");
  problem("<phase type=\"raleigh\"/>", "unknown phase type 'raleigh'");
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
  EXPECT_EQ(message_of(media_camera + "<medium type=\"homogenous\"/>" + media_sphere),
            "unknown medium type 'homogenous'");
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
