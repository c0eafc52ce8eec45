// Scenes that Mitsuba takes, or that hold what a dialect adds: they are built, with one warning for
// what is not quite as they say.

#include <fstream>
#include <vector>

#include "tests/scene/scene_support.h"
#include "tests/support/temporary_folder.h"

namespace kaustik {
namespace {

using namespace test;

const std::string a_camera = any_camera;

std::string a_ball(const std::string& inside) {
  return a_camera + "\n<shape type=\"sphere\">" + inside + "</shape>";
}

/// The scene, which is an error where it is read strictly. Expects one warning with this part.
std::shared_ptr<const Scene> told(const std::string& objects, const std::string& part) {
  SCOPED_TRACE(objects);
  Description description = description_of(objects);
  const auto scene = build_scene(description);
  EXPECT_EQ(scene->warnings().size(), 1u);
  if (!scene->warnings().empty()) {
    EXPECT_NE(scene->warnings()[0].find(part), std::string::npos) << scene->warnings()[0];
  }
  description.is_strict = true;
  EXPECT_THROW(build_scene(description), Error);
  return scene;
}

float reflected(const Scene& scene) {
  return scene.surface(0).bsdf->albedo({}, {0, 0, 1}, Lobes::all)[1];
}

const std::string white = "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"1\"/></bsdf>";
const std::string black = "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0\"/></bsdf>";

std::string checkers(const std::string& name, double a, double b) {
  return "<texture type=\"checkerboard\" name=\"" + name + "\"><rgb name=\"color0\" value=\"" +
         std::to_string(a) + "\"/><rgb name=\"color1\" value=\"" + std::to_string(b) +
         "\"/></texture>";
}

// Where Mitsuba takes a texture for a number, it takes a colour, and asks it for its luminance.
TEST(Leniency, ColoursCountByTheirLuminanceWhereOneNumberIsAsked) {
  const auto share = [](const std::string& colour) {
    const auto scene = scene_of(a_ball("<bsdf type=\"blendbsdf\"><rgb name=\"weight\" value=\"" +
                                       colour + "\"/>" + black + white + "</bsdf>"));
    EXPECT_TRUE(scene->warnings().empty());
    return reflected(*scene);
  };
  EXPECT_FLOAT_EQ(share("0.25"), 0.25f);
  EXPECT_FLOAT_EQ(share("1, 1, 1"), 1);
  EXPECT_NEAR(share("1, 0, 0"), 0.2126f, 1e-3f);
  EXPECT_NEAR(share("0, 1, 0"), 0.7152f, 1e-3f);
  EXPECT_NO_THROW(
      scene_of(a_ball("<bsdf type=\"roughconductor\"><rgb name=\"alpha\" value=\"0.2, "
                      "0.3, 0.1\"/></bsdf>")));
  // Where no texture may stand there is no colour either.
  expect_problem(a_camera + "\n<shape type=\"sphere\"><rgb name=\"radius\" value=\"1\"/></shape>",
                 "3:22", "'radius' has the wrong type");
}

TEST(Leniency, TheMeanOfATextureStandsWhereNoneIsTaken) {
  const auto scene = told(
      a_camera + "\n<emitter type=\"point\">" + checkers("intensity", 1, 3) + "</emitter>" +
          any_shape,
      "'intensity' of emitter 'point' takes no texture: the mean of the texture stands for it");
  const auto same = scene_of(a_camera +
                             "<emitter type=\"point\"><rgb name=\"intensity\" value=\"2\"/>"
                             "</emitter>" +
                             any_shape);
  EXPECT_NEAR(scene->lights()[0]->traits().power[1], same->lights()[0]->traits().power[1], 1e-4f);
  told(a_ball("<bsdf type=\"conductor\">" + checkers("eta", 0.2, 1.5) +
              "<float name=\"k\" value=\"7\"/></bsdf>"),
       "'eta' of bsdf 'conductor' takes no texture");
  told(a_ball("<bsdf type=\"coating\">" + checkers("sigma_a", 0.2, 1.5) + white + "</bsdf>"),
       "'sigma_a' of bsdf 'coating' takes no texture");
}

TEST(Leniency, TexturesOfOtherProgramsAreLeftOut) {
  const auto scene = told(a_ball("<bsdf type=\"plastic\">" + checkers("bumpMap", 0, 1) + "</bsdf>"),
                          "bsdf 'plastic' takes no texture 'bumpMap': it is left out");
  EXPECT_FLOAT_EQ(reflected(*scene), reflected(*scene_of(a_ball("<bsdf type=\"plastic\"/>"))));
  told(a_ball("<bsdf type=\"diffuse\">" + checkers("glitter", 0, 1) + "</bsdf>"), "'glitter'");
}

TEST(Leniency, ReliefsOfForeignTexturesAreLeftOut) {
  for (const char* inside : {"<texture type=\"wireframe\"/>",
                             "<texture type=\"scale\"><texture type=\"wireframe\"/></texture>"}) {
    const auto scene =
        told(a_ball(std::string("<bsdf type=\"bumpmap\">") + inside + white + "</bsdf>"),
             "texture 'wireframe' here yet: the bsdf in 'bumpmap' stands for it");
    EXPECT_FLOAT_EQ(reflected(*scene), 1);
  }
  const auto scaled = told(a_ball("<bsdf type=\"diffuse\"><texture type=\"scale\" "
                                  "name=\"reflectance\"><texture type=\"curvature\"/></texture>"
                                  "</bsdf>"),
                           "texture 'curvature' here yet: it is left out");
  EXPECT_FLOAT_EQ(reflected(*scaled), 0.5f);
}

// Mitsuba applies both.
TEST(Leniency, OfTwoReliefsTheInnerOneHolds) {
  const std::string bumped = "<bsdf type=\"bumpmap\"><texture type=\"noise\"/>" + white + "</bsdf>";
  const auto scene = told(a_ball("<bsdf type=\"normalmap\"><texture name=\"normalmap\" "
                                 "type=\"noise\"/>" +
                                 bumped + "</bsdf>"),
                          "holds another bump or normal map: the inner one holds");
  EXPECT_NE(scene->surface(0).bsdf->relief(true), nullptr);
}

TEST(Leniency, NumbersBeyondTheirRangesAreTakenToItsEnds) {
  const std::string mask = "<bsdf type=\"mask\"><float name=\"opacity\" value=\"";
  EXPECT_FLOAT_EQ(reflected(*told(a_ball(mask + "1.5\"/>" + black + "</bsdf>"),
                                  "'opacity' of bsdf 'mask' is beyond its range: 1 is taken")),
                  0);
  const auto open = told(a_ball(mask + "-1\"/>" + black + "</bsdf>"), "0 is taken");
  EXPECT_FLOAT_EQ(open->surface(0).bsdf->straight({}, {0, 0, 1})[0], 1);
  told(a_ball("<bsdf type=\"principled\"><float name=\"roughness\" value=\"1.2\"/></bsdf>"),
       "'roughness'");
  told(a_ball("<bsdf type=\"phong\"><float name=\"exponent\" value=\"1e9\"/></bsdf>"),
       "'exponent'");
  told(a_ball("<bsdf type=\"principled\"><float name=\"specular\" value=\"20\"/></bsdf>"),
       "'specular' of bsdf 'principled' is beyond its range: 12 is taken");
  EXPECT_TRUE(
      scene_of(a_ball("<bsdf type=\"principled\"><float name=\"specular\" value=\"1.5\"/></bsdf>"))
          ->warnings()
          .empty());
  told(a_ball("<bsdf type=\"principledthin\"><float name=\"diff_trans\" value=\"3\"/></bsdf>"),
       "2 is taken");
  told(a_ball("<bsdf type=\"roughplastic\"><float name=\"alpha\" value=\"-1\"/></bsdf>"),
       "0 is taken");
  told(a_ball("<bsdf type=\"roughdiffuse\"><float name=\"alpha\" value=\"20\"/></bsdf>"),
       "10 is taken");
  told(a_camera + std::string(any_shape) +
           "<emitter type=\"sky\"><float name=\"turbidity\" value=\"20\"/></emitter>",
       "'turbidity' of emitter 'sky' is beyond its range: 10 is taken");
  // A radius is what it is.
  expect_problem(
      a_camera + "\n<shape type=\"sphere\"><float name=\"radius\" value=\"-1\"/></shape>", "3:22",
      "outside its range");
}

TEST(Leniency, SheetsThatTransmitHaveTwoSidesAlready) {
  const std::string inside = white + "</bsdf>";
  EXPECT_FLOAT_EQ(reflected(*scene_of(a_ball("<bsdf type=\"twosided\"><boolean "
                                             "name=\"allow_transmission\" value=\"true\"/>" +
                                             inside))),
                  1);
  const std::string glass = "<bsdf type=\"dielectric\"/></bsdf>";
  const auto scene = scene_of(a_ball(
      "<bsdf type=\"twosided\"><boolean name=\"allow_transmission\" value=\"true\"/>" + glass));
  EXPECT_TRUE(scene->surface(0).bsdf->traits().transmits);
  expect_problem(
      a_camera + "\n<shape type=\"sphere\"><bsdf type=\"twosided\">" + glass + "</shape>", "3:22",
      "transmits light");
}

/// Before the camera.
std::string fog(const std::string& inside, const std::string& type = "homogeneous") {
  return a_camera +
         "<shape type=\"sphere\"><point name=\"center\" value=\"0, 0, 9\"/>\n<medium "
         "name=\"interior\" type=\"" +
         type + "\">" + inside + "</medium></shape>";
}
double mean_cosine(const Scene& scene) { return scene.surface(0).interior->phase().mean_cosine(); }

TEST(Leniency, PhaseFunctionsThatNobodyKnowsAreIsotropic) {
  for (const char* type : {"sggx", "kkay", "microflake", "vonmises"})
    EXPECT_EQ(mean_cosine(*told(fog(std::string("<phase type=\"") + type + "\"/>"),
                                "an isotropic one stands for it")),
              0);
}

// Of Mitsuba, and of no effect on the picture: also where a scene is read strictly.
TEST(Leniency, WhatChangesNoLightIsTaken) {
  Description description = description_of(fog("<string name=\"strategy\" value=\"balance\"/>"));
  description.is_strict = true;
  EXPECT_EQ(build_scene(description)->warnings(),
            std::vector<std::string>{
                "without effect here: 'strategy' of medium 'homogeneous' (test.xml:3:44)"});
}

TEST(Leniency, MixturesOfPhaseFunctions) {
  const std::string parts =
      "<phase type=\"hg\"><float name=\"g\" value=\"0.8\"/></phase>"
      "<phase type=\"isotropic\"/><phase type=\"hg\"><float name=\"g\" value=\"-0.4\"/></phase>";
  const auto mixture = [&](const std::string& weights) {
    return fog("<phase type=\"mixturephase\"><string name=\"weights\" value=\"" + weights + "\"/>" +
               parts + "</phase>");
  };
  EXPECT_NEAR(mean_cosine(*scene_of(mixture("0.5, 0.25, 0.25"))), 0.3, 1e-6);
  EXPECT_NEAR(mean_cosine(*scene_of(mixture("0, 0, 2"))), -0.4, 1e-6);
  expect_problem(mixture("0.5, 0.5"), "3:71", "'weights' has 2 numbers, for 3 phase functions");
  expect_problem(mixture("1, -1, 1"), "3:71", "'weights' holds -1, which is below 0");
  // Each is made as often as it is held.
  std::string nested = "<phase type=\"isotropic\"/>";
  for (int i = 0; i < 4; ++i)
    nested =
        "<phase type=\"mixturephase\"><string name=\"weights\" value=\"1\"/>" + nested + "</phase>";
  EXPECT_EQ(problems_of(fog(nested))[0].message, "phase functions nest too deep");
}

TEST(Leniency, VolumesAndMediaThatNobodyKnows) {
  EXPECT_EQ(told(fog("", "smokesimulation"), "it is left out, and space is empty there")
                ->surface(0)
                .interior,
            nullptr);
  EXPECT_EQ(
      told(fog("<volume name=\"albedo\" type=\"vdb\"/>"), "volume 'vdb' here yet: it is left out")
          ->surface(0)
          .interior->scattering({}, {}),
      Spectrum(0.75f));
  const auto constant = [](const std::string& name, const char* value) {
    return "<volume name=\"" + name + "\" type=\"constvolume\"><float name=\"value\" value=\"" +
           value + "\"/></volume>";
  };
  told(fog(constant("orientation", "1")), "takes no volume 'orientation': it is left out");
  const auto cached =
      told(fog("<volume name=\"albedo\" type=\"volcache\">" + constant("x", "0.25") + "</volume>"),
           "the volume in it stands for it");
  EXPECT_EQ(cached->surface(0).interior->scattering({}, {}), Spectrum(0.25f));
  const auto blend = scene_of(fog("<phase type=\"blendphase\">" + constant("weight", "0.25") +
                                  "<phase type=\"isotropic\"/><phase type=\"hg\"><float name=\"g\" "
                                  "value=\"0.8\"/></phase></phase>"));
  EXPECT_NEAR(mean_cosine(*blend), 0.2, 1e-6);
}

TEST(Leniency, MediaThatGlow) {
  for (const std::string emission :
       {"<rgb name=\"emission\" value=\"1\"/>", "<float name=\"emission\" value=\"3\"/>",
        "<volume type=\"constvolume\" name=\"emission\"><rgb name=\"value\" "
        "value=\"1\"/></volume>",
        "<spectrum type=\"d65\" name=\"emission\"/>"})
    told(fog(emission, "heterogeneous"),
         "media do not glow yet: 'emission' of medium 'heterogeneous' is left out");
}

TEST(Leniency, TwoBsdfsInTwosidedThatTransmit) {
  const std::string allowed = "<boolean name=\"allow_transmission\" value=\"true\"/>";
  const std::string glass = "<bsdf type=\"dielectric\"/>";
  const auto scene = told(a_ball("<bsdf type=\"twosided\">" + allowed + white + glass + "</bsdf>"),
                          "holds two, and light is transmitted: the first is used as it is");
  EXPECT_FLOAT_EQ(reflected(*scene), 1);
  EXPECT_FALSE(scene->surface(0).traits.transmits);
  EXPECT_THROW(scene_of(a_ball("<bsdf type=\"twosided\">" + white + glass + "</bsdf>")), Error);
  expect_problem(a_camera + "\n<shape type=\"sphere\"><bsdf type=\"twosided\"/></shape>", "3:22",
                 "holds 0 bsdfs", "give it 1 or 2");
}

// As Mitsuba 0.6 has it; Mitsuba 3 refuses it.
TEST(Leniency, ABsdfInAnInstance) {
  Description description =
      description_of(a_camera + "<shape type=\"shapegroup\" id=\"g\">" + any_shape +
                     "</shape>\n<shape type=\"instance\"><ref id=\"g\"/>" + black + "</shape>");
  const auto scene = build_scene(description);
  EXPECT_EQ(scene->tracer().geometry().instances.size(), 1u);
  ASSERT_EQ(scene->warnings().size(), 1u);
  EXPECT_NE(scene->warnings()[0].find("a bsdf in an instance has no effect"), std::string::npos);
  description.is_strict = true;
  try {
    build_scene(description);
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    ASSERT_EQ(error.problems().size(), 1u);
    EXPECT_EQ(error.problems()[0].message, "shape 'instance' cannot hold a bsdf");
  }
}

// Mitsuba has them, and they change no light here: no error where scenes are read strictly.
TEST(Leniency, ParametersWithoutEffect) {
  for (const std::string& objects :
       {a_camera + any_shape +
            "<emitter type=\"sky\"><float name=\"stretch\" value=\"1\"/>"
            "<integer name=\"resolution\" value=\"64\"/></emitter>",
        "<sensor type=\"perspective\"><film type=\"specfilm\"><spectrum name=\"band1\" "
        "value=\"400:1, 500:1\"/><spectrum type=\"regular\" name=\"band2\"><float "
        "name=\"wavelength_min\" value=\"400\"/><float name=\"wavelength_max\" value=\"500\"/>"
        "<string name=\"values\" value=\"1, 1\"/></spectrum></film></sensor>" +
            std::string(any_shape)}) {
    Description description = description_of(objects);
    description.is_strict = true;
    const auto scene = build_scene(description);
    ASSERT_EQ(scene->warnings().size(), 1u);
    EXPECT_NE(scene->warnings()[0].find("without effect here: "), std::string::npos);
  }
}

// As in Mitsuba 0.6.
TEST(Leniency, EnvironmentsWithAGamma) {
  const TemporaryFolder folder;
  std::ofstream picture(folder.path("sky.pfm"), std::ios::binary);
  picture << "PF\n4 2\n-1.0\n";
  const std::vector<float> values(4 * 2 * 3, 0.25f);
  picture.write(reinterpret_cast<const char*>(values.data()),
                std::streamsize(values.size() * sizeof(float)));
  picture.close();
  const auto power = [&](const std::string& gamma) {
    const auto scene = scene_of(a_camera + any_shape +
                                "<emitter type=\"envmap\"><string name=\"filename\" value=\"" +
                                folder.path("sky.pfm") + "\"/>" + gamma + "</emitter>");
    return scene->lights().at(0)->traits().power[1];
  };
  EXPECT_NEAR(power("<float name=\"gamma\" value=\"2\"/>") / power(""), 0.25f, 1e-5f);
}

TEST(Leniency, TypesOfMitsubaThatAreToCome) {
  told(a_ball("<bsdf type=\"hair\"/>"),
       "there is no bsdf 'hair' here yet: a matt surface stands for it; use 'principled'");
  told(a_camera + std::string(any_shape) + "<shape type=\"bsplinecurve\"/>",
       "there is no shape 'bsplinecurve' here yet: it is left out; export the curves");
  told(a_camera + std::string(any_shape) + "<emitter type=\"collimated\"/>",
       "there is no emitter 'collimated' here yet: it is left out; use a 'spot'");
}

}  // namespace
}  // namespace kaustik
