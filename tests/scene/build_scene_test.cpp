// From descriptions to scenes: defaults, nesting, sharing, and every way to get it wrong.

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/scene/scene_support.h"

namespace kaustik {
namespace {

using namespace test;

const std::string camera = any_camera;
const std::string sphere = any_shape;

TEST(BuildScene, Defaults) {
  const auto scene = scene_of(camera + sphere);
  EXPECT_EQ(scene->film().size, Vec2i(768, 576));
  EXPECT_EQ(scene->film().crop_size, Vec2i(768, 576));
  EXPECT_EQ(scene->film().crop_offset, Vec2i(0, 0));
  EXPECT_EQ(scene->film().sample_count, 0);
  EXPECT_FLOAT_EQ(scene->film().filter.radius(), 2.0f);  // Gaussian, 4 × 0.5 pixels
  EXPECT_EQ(scene->camera().traits().position, Vec3f(0, 0, 0));
  EXPECT_TRUE(scene->lights().empty());
  EXPECT_TRUE(scene->warnings().empty());
  ASSERT_EQ(scene->surface_count(), 1u);
  // Without a bsdf a shape is diffuse with reflectance one half, as in Mitsuba.
  const Surface& surface = scene->surface(0);
  EXPECT_EQ(surface.light, -1);
  EXPECT_EQ(surface.bsdf->traits().lobes, Lobes::diffuse);
  EXPECT_FLOAT_EQ(surface.bsdf->albedo({}, {0, 0, 1}, Lobes::all)[0], 0.5f);
}

TEST(BuildScene, FilmFilterAndSampler) {
  const auto scene = scene_of(
      "<sensor type=\"perspective\">" +
      film(100, 50,
           "<integer name=\"crop_offset_x\" value=\"10\"/><integer name=\"crop_width\" "
           "value=\"30\"/><integer name=\"crop_offset_y\" value=\"20\"/>"
           "<rfilter type=\"tent\"><float name=\"radius\" value=\"1.5\"/></rfilter>") +
      "<sampler type=\"multijitter\"><integer name=\"sample_count\" value=\"64\"/></sampler>"
      "</sensor>" +
      sphere);
  EXPECT_EQ(scene->film().size, Vec2i(100, 50));
  EXPECT_EQ(scene->film().crop_offset, Vec2i(10, 20));
  EXPECT_EQ(scene->film().crop_size, Vec2i(30, 30));  // the rest of the height
  EXPECT_FLOAT_EQ(scene->film().filter.radius(), 1.5f);
  EXPECT_EQ(scene->film().sample_count, 64);
  EXPECT_EQ(scene->film().place.line, 2);
}

// Films of other programs hold the same picture; what is nobody's is told and stood for.
TEST(BuildScene, ForeignFilmsFiltersAndSamplers) {
  const std::string inside =
      "<integer name=\"width\" value=\"40\"/><float name=\"exposure\" value=\"1\"/>"
      "<float name=\"iso\" value=\"200\"/>";
  for (const std::string name :
       {"ldrfilm", "mfilm", "tiledhdrfilm", "exrfilm", "pngfilm", "specfilm"}) {
    const auto scene =
        seen_by("<film type=\"" + name + "\">" + inside + "</film><sampler type=\"sobol\"/>");
    EXPECT_EQ(scene->film().size.x, 40) << name;
    EXPECT_FLOAT_EQ(scene->film().exposure, 2) << name;
    EXPECT_TRUE(scene->warnings().empty()) << name;
  }
  const std::string unknown = "<film type=\"papyrus\">" + inside +
                              "<rfilter type=\"gausian\"/></film><sampler type=\"dice\"><integer "
                              "name=\"sample_count\" value=\"9\"/></sampler>";
  const auto scene = seen_by(unknown);
  EXPECT_EQ(scene->film().size.x, 40);
  EXPECT_EQ(scene->film().filter.radius(), 2);
  EXPECT_EQ(scene->film().sample_count, 9);
  ASSERT_EQ(scene->warnings().size(), 3u);
  EXPECT_NE(scene->warnings()[0].find("unknown film type 'papyrus': 'hdrfilm' is used"),
            std::string::npos);
  EXPECT_NE(scene->warnings()[1].find("did you mean 'gaussian'"), std::string::npos);
  Description strict =
      description_of("<sensor type=\"perspective\">" + unknown + "</sensor>" + sphere);
  strict.is_strict = true;
  EXPECT_THROW(build_scene(strict), Error);
}

// One warning for the camera and its parameter; the view is that of the pinhole.
TEST(BuildScene, RadialDistortionIsLeftOut) {
  const std::string distorting =
      "<sensor type=\"perspective_rdist\"><string name=\"kc\" value=\"0.1, 0.02\"/>"
      "<float name=\"fov\" value=\"50\"/></sensor>" +
      sphere;
  const auto scene = scene_of(distorting);
  EXPECT_NEAR(scene->camera().traits().horizontal_fov, 50, 1e-3);
  ASSERT_EQ(scene->warnings().size(), 1u);
  EXPECT_NE(scene->warnings()[0].find("'perspective' stands for it, without its radial distortion"),
            std::string::npos)
      << scene->warnings()[0];
  Description strict = description_of(distorting);
  strict.is_strict = true;
  EXPECT_THROW(build_scene(strict), Error);
}

TEST(BuildScene, SurfacesAreNamedForMessages) {
  const auto scene = scene_of(camera + "<shape type=\"cube\" id=\"box\"/>\n" + sphere);
  EXPECT_EQ(scene->surface(0).name, "box");
  EXPECT_EQ(scene->surface(1).name, "shape 'sphere' on line 3");
}

TEST(BuildScene, ReferredBsdfsAreShared) {
  const auto scene =
      scene_of(camera + "<bsdf type=\"twosided\" id=\"paint\"><bsdf type=\"diffuse\"/></bsdf>" +
               "<shape type=\"sphere\"><ref id=\"paint\"/></shape>"
               "<shape type=\"cube\"><ref id=\"paint\"/></shape><shape type=\"disk\"/>");
  EXPECT_EQ(scene->surface(0).bsdf, scene->surface(1).bsdf);
  EXPECT_NE(scene->surface(0).bsdf, scene->surface(2).bsdf);
}

TEST(BuildScene, LightsKnowTheirShapesAndShapesTheirLights) {
  const auto scene = scene_of(camera + "<emitter type=\"constant\"/>" + sphere +
                              "<shape type=\"disk\"><emitter type=\"area\"/></shape>"
                              "<emitter type=\"point\"/>"
                              "<shape type=\"cube\"><emitter type=\"area\"/></shape>");
  ASSERT_EQ(scene->lights().size(), 4u);
  EXPECT_EQ(scene->surface(0).light, -1);
  for (uint32_t shape : {1u, 2u}) {
    const int light = scene->surface(shape).light;
    ASSERT_GE(light, 0);
    EXPECT_EQ(scene->lights()[size_t(light)]->traits().shape, int(shape));
  }
  EXPECT_EQ(scene->environment_lights(), std::vector<int>{0});
}

/// Distance along a ray from (x, 0, -10) along +z; infinite if there is nothing.
float depth_at(const Scene& scene, float x) {
  Hit hit;
  return scene.intersect({{x, 0, -10}, {0, 0, 1}}, hit) ? hit.t : infinity;
}

TEST(BuildScene, GroupsAppearOnlyWhereTheyAreInstanced) {
  const std::string group =
      "<shape type=\"shapegroup\" id=\"pair\">"
      "<shape type=\"sphere\" id=\"ball\"><bsdf type=\"conductor\"/></shape>"
      "<shape type=\"sphere\"><point name=\"center\" x=\"4\" y=\"0\" z=\"0\"/></shape></shape>";
  const auto instance = [](double x, double scale) {
    return "<shape type=\"instance\"><ref id=\"pair\"/><transform name=\"to_world\"><scale "
           "value=\"" +
           std::to_string(scale) + "\"/><translate x=\"" + std::to_string(x) +
           "\"/></transform></shape>";
  };
  const auto scene =
      scene_of(camera + group + instance(20, 1) + instance(40, 2) + "<shape type=\"cube\"/>");
  EXPECT_FLOAT_EQ(depth_at(*scene, 0), 9);  // the cube; not the group itself
  EXPECT_EQ(depth_at(*scene, 4), infinity);
  EXPECT_FLOAT_EQ(depth_at(*scene, 20), 9);
  EXPECT_FLOAT_EQ(depth_at(*scene, 24), 9);
  EXPECT_FLOAT_EQ(depth_at(*scene, 40), 8);
  EXPECT_FLOAT_EQ(depth_at(*scene, 48), 8);
  // Both instances share the surfaces of the group.
  ASSERT_EQ(scene->surface_count(), 3u);
  for (const float x : {20.0f, 40.0f}) {
    const Ray ray{{x, 0, -10}, {0, 0, 1}};
    Hit hit;
    ASSERT_TRUE(scene->intersect(ray, hit));
    EXPECT_EQ(scene->surface(scene->tracer().surface_point(ray, hit).shape).name, "ball");
  }
  EXPECT_EQ(scene_of(camera + group + sphere)->surface_count(), 1u);
}

TEST(BuildScene, GroupsThatCannotBe) {
  const std::string instance = "<shape type=\"instance\"><ref id=\"g\"/></shape>";
  expect_problem(camera + "\n<shape type=\"shapegroup\" id=\"g\"/>" + instance, "3:1",
                 "the shape group is empty", "add a shape");
  expect_problem(camera + "\n<shape type=\"instance\"/>", "3:1",
                 "an instance needs exactly one shape group", "of type 'shapegroup'");
  expect_problem(camera + "\n<shape type=\"sphere\" id=\"g\"/>" + instance, "3:30",
                 "an instance needs exactly one shape group", "of type 'shapegroup'");
}

TEST(BuildScene, WhatIsMissing) {
  expect_problem("", "1:1", "the scene has no camera", "add a sensor of type 'perspective'");
  expect_problem(camera + "<shape type=\"ply\"/>", "2:29", "shape 'ply' needs 'filename'");
}

TEST(BuildScene, WhatIsThereTwice) {
  expect_problem(
      "<sensor type=\"perspective\"><film type=\"hdrfilm\"/>\n<film "
      "type=\"hdrfilm\"/></sensor>" +
          sphere,
      "3:1", "second film", "the first is here: test.xml:2:");
  expect_problem(
      "<sensor type=\"perspective\"><sampler type=\"independent\"/>\n<sampler "
      "type=\"stratified\"/></sensor>" +
          sphere,
      "3:1", "the camera has a second sampler", "the first is here: test.xml:2:");
  expect_problem(
      "<sensor type=\"perspective\"><film type=\"hdrfilm\"><rfilter type=\"box\"/>\n<rfilter "
      "type=\"tent\"/></film></sensor>" +
          sphere,
      "3:1", "the film has a second rfilter", "the first is here: test.xml:2:");
  expect_problem(camera +
                     "<shape type=\"disk\"><bsdf type=\"diffuse\"/>\n<bsdf "
                     "type=\"diffuse\"/></shape>",
                 "3:1", "second bsdf");
  expect_problem(camera +
                     "<shape type=\"disk\"><emitter type=\"area\"/>\n<emitter "
                     "type=\"area\"/></shape>",
                 "3:1", "second emitter");
  const Description two =
      description_of(camera + sphere + "<integrator type=\"path\"/>\n<integrator type=\"path\"/>");
  EXPECT_THROW(find_integrator(two), Error);
}

TEST(BuildScene, TellsOfLobesThatAreCut) {
  const auto warnings = [](const std::string& filter) {
    return scene_of("<sensor type=\"perspective\">" + film(8, 8, "\n" + filter) + "</sensor>" +
                    sphere)
        ->warnings();
  };
  const auto told = warnings("<rfilter type=\"mitchell\"/>");
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].find("test.xml:3:1: of filter 'mitchell'"), 0u) << told[0];
  EXPECT_TRUE(warnings("<rfilter type=\"gaussian\"/>").empty());
}

// Nested bsdfs count by their names, as in Mitsuba 3.
TEST(BuildScene, OrderOfNestedBsdfs) {
  const auto first_of = [](const std::string& name_a, const std::string& name_b) {
    const auto nested = [](const std::string& name, const std::string& reflectance) {
      return "<bsdf type=\"diffuse\"" + (name.empty() ? "" : " name=\"" + name + "\"") +
             "><float name=\"reflectance\" value=\"" + reflectance + "\"/></bsdf>";
    };
    const auto scene = scene_of(camera +
                                "<shape type=\"sphere\"><bsdf type=\"blendbsdf\"><float "
                                "name=\"weight\" value=\"0.25\"/>" +
                                nested(name_a, "0.4") + nested(name_b, "0.8") + "</bsdf></shape>");
    const float albedo =
        scene->surface(0).bsdf->albedo(BsdfContext(), Vec3f(0, 0, 1), Lobes::all)[0];
    // Three quarters of the first, one quarter of the second.
    if (std::fabs(albedo - 0.5f) < 1e-5f) return "a";
    return std::fabs(albedo - 0.7f) < 1e-5f ? "b" : "neither";
  };
  EXPECT_STREQ(first_of("", ""), "a");
  EXPECT_STREQ(first_of("bsdf_0", "bsdf_1"), "a");
  EXPECT_STREQ(first_of("bsdf_1", "bsdf_0"), "b");
  EXPECT_STREQ(first_of("b10", "b9"), "b");
  EXPECT_STREQ(first_of("b9", "b10"), "a");
  EXPECT_STREQ(first_of("coat", "base"), "b");
}

TEST(BuildScene, ScenesWithoutShapes) {
  const auto scene = scene_of(camera + "<emitter type=\"constant\"/>");
  EXPECT_EQ(scene->surface_count(), 0u);
  EXPECT_TRUE(std::isfinite(scene->lights().at(0)->traits().power.sum()));
  EXPECT_GT(scene->lights().at(0)->traits().power.sum(), 0);
  EXPECT_NO_THROW(scene_of(camera));
  EXPECT_NO_THROW(scene_of(camera + "<shape type=\"shapegroup\" id=\"g\"/>"));
}

/// The one of the top level is the scene's; of several, the one that no shape refers to.
TEST(BuildScene, WhichIntegratorIsTheScenes) {
  const std::string plain = "<integrator type=\"localphong\" id=\"plain\"/>\n",
                    main = "<integrator type=\"path\" id=\"main\"/>\n";
  const auto ball_with = [](const std::string& id) {
    return "<shape type=\"sphere\"><ref id=\"" + id + "\"/></shape>";
  };
  EXPECT_EQ(find_integrator(description_of(plain + camera + ball_with("plain")))->type,
            "localphong");
  EXPECT_EQ(find_integrator(description_of(plain + main + camera + ball_with("plain")))->type,
            "path");
  try {
    find_integrator(description_of(plain + main + camera + ball_with("plain") + ball_with("main")));
    FAIL();
  } catch (const Error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("no integrator of its own"), std::string::npos) << text;
    EXPECT_NE(text.find("here: test.xml:2:1, test.xml:3:1"), std::string::npos) << text;
  }
}

/// Descriptions of programs may have no places: messages then tell of none.
TEST(BuildScene, DescriptionsWithoutPlaces) {
  const auto sensor = [] {
    return std::make_shared<Object>(Object{"sensor", "perspective", "", {}, {}, {}});
  };
  const auto ball = std::make_shared<Object>(Object{"shape", "sphere", "", {}, {}, {}});
  const Description two{std::make_shared<Object>(
      Object{"scene", "", "", {}, {{"", sensor()}, {"", sensor()}, {"", ball}}, {}})};
  EXPECT_EQ(build_scene(two)->warnings(),
            std::vector<std::string>{
                "the scene has more than one camera: sensor 'perspective' is not used"});
  const Description none{std::make_shared<Object>(Object{"scene", "", "", {}, {}, {}})};
  try {
    build_scene(none);
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "the scene has no camera\n  remedy: add a sensor of type 'perspective', with a "
                 "'to_world'");
  }
  const Description one{
      std::make_shared<Object>(Object{"scene", "", "", {}, {{"", sensor()}, {"", ball}}, {}})};
  EXPECT_EQ(build_scene(one)->surface(0).name, "shape 'sphere'");
}

TEST(BuildScene, WhatStandsInTheWrongPlace) {
  expect_problem(camera + "\n<shape type=\"sphere\"><film type=\"hdrfilm\"/></shape>", "3:22",
                 "shape 'sphere' cannot hold a film", "bsdf, emitter");
  expect_problem(camera + sphere + "\n<emitter type=\"area\"/>", "3:1", "stands outside of a shape",
                 "into the shape that shines");
  expect_problem(camera + "\n<shape type=\"sphere\"><emitter type=\"point\"/></shape>", "3:22",
                 "cannot belong to a shape", "at the top");
  expect_problem(camera + sphere + "\n<bsdf type=\"twosided\"/>", "3:1",
                 "bsdf 'twosided' holds 0 bsdfs", "give it 1");
  expect_problem(camera + sphere +
                     "\n<bsdf type=\"diffuse\"><texture type=\"checkerboard\" "
                     "name=\"reflectanc\"/></bsdf>",
                 "3:22", "takes no texture 'reflectanc'", "did you mean 'reflectance'?");
}

// Mitsuba's scenes may hold a lamp for shapes to refer to.
TEST(BuildScene, LampsThatShapesReferTo) {
  const std::string lamp = R"(<emitter type="area" id="lamp"/>)",
                    shining = R"(<shape type="sphere"><ref id="lamp"/></shape>)";
  const auto scene = build_scene(parse_mitsuba_xml(
      "<scene version=\"3.0.0\">" + camera + lamp + shining + shining + "</scene>", "t.xml", ""));
  EXPECT_EQ(scene->lights().size(), 2u);
  EXPECT_TRUE(scene->warnings().empty());
  const auto dark = build_scene(parse_mitsuba_xml(
      "<scene version=\"3.0.0\">" + camera + lamp + sphere + "</scene>", "t.xml", ""));
  EXPECT_TRUE(dark->lights().empty());
  EXPECT_EQ(dark->warnings(),
            std::vector<std::string>{"emitter 'lamp' belongs to no shape: it is left out"});
}

// Foreign programs write parameters of their own.
TEST(BuildScene, ForeignParametersAreLeftOut) {
  const std::string text = "<scene version=\"3.0.0\">" + camera + sphere +
                           "\n<shape type=\"sphere\"><float name=\"radius\" value=\"2\"/>"
                           "<integer name=\"tiles\" value=\"2\"/></shape>"
                           "<shape type=\"sphere\"><integer name=\"tiles\" value=\"2\"/></shape>"
                           "</scene>";
  Description description = parse_mitsuba_xml(text, "t.xml", "");
  EXPECT_EQ(build_scene(description)->warnings(),
            std::vector<std::string>{"t.xml:2:54: shape 'sphere' has no parameter 'tiles': it is "
                                     "left out, and 1 more like it"});
  description.is_strict = true;
  EXPECT_THROW(build_scene(description), Error);
}

/// Warnings of a scene, which is an error where it is read strictly.
std::vector<std::string> lenient_warnings(const std::string& objects) {
  SCOPED_TRACE(objects);
  Description description = description_of(objects);
  const std::vector<std::string> warnings = build_scene(description)->warnings();
  description.is_strict = true;
  EXPECT_THROW(build_scene(description), Error);
  return warnings;
}

void expect_one(const std::vector<std::string>& warnings, const std::string& part) {
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find(part), std::string::npos) << warnings[0];
}

// What a dialect has of its own is left out, or something stands for it. What looks like a slip of
// the pen is an error: see the tests of unknown types.
TEST(BuildScene, TypesOfDialects) {
  expect_one(lenient_warnings(camera + sphere + "\n<shape type=\"hairball\"/>"),
             "test.xml:3:1: Kaustik does not know shape 'hairball': it is left out");
  expect_one(lenient_warnings(camera + sphere + "<emitter type=\"point\"/>" +
                              "\n<emitter type=\"volumelight\"/>"),
             "test.xml:3:1: Kaustik does not know emitter 'volumelight'");
  // Also the only light.
  expect_one(lenient_warnings(camera + sphere + "\n<emitter type=\"volumelight\"/>"),
             "test.xml:3:1: Kaustik does not know emitter 'volumelight': it is left out");
  expect_one(lenient_warnings(camera + sphere + "\n<emitter type=\"collimated\"/>"),
             "it is left out; use a 'spot'");
  expect_one(lenient_warnings(camera + sphere +
                              "\n<emitter type=\"ringflash\">"
                              "<rgb name=\"intensity\" value=\"1\"/></emitter>"),
             "'point' stands for it");
  expect_one(lenient_warnings(camera + "<shape type=\"sphere\"><emitter type=\"angularlamp\">"
                                       "<rgb name=\"radiance\" value=\"1\"/></emitter></shape>"),
             "'area' stands for it");
  expect_one(lenient_warnings(camera + "<emitter type=\"point\"/><shape type=\"sphere\">"
                                       "<bsdf type=\"polarizer\"/></shape>"),
             "half of the light passes");
  expect_one(lenient_warnings(camera + sphere +
                              "<shape type=\"sphere\">"
                              "<sensor type=\"nlos_capture\"/></shape>"),
             "Kaustik does not know sensor 'nlos_capture': it is left out");
  expect_one(lenient_warnings("<sensor type=\"dome360\"/>" + sphere), "'perspective' is used");
  expect_one(lenient_warnings(camera + sphere + "\n<film type=\"hdrfilm\"/>"),
             "a film stands at the top of the scene");
  expect_one(lenient_warnings(camera + sphere + "\n<float name=\"gamma\" value=\"1\"/>"),
             "the scene has no parameter 'gamma'");
}

/// Lamps keep their surfaces, though one before them is left out.
TEST(BuildScene, LampsBehindOneThatIsLeftOut) {
  const auto scene =
      scene_of(camera +
               "<emitter type=\"volumelight\"/><emitter type=\"point\"/>"
               "<shape type=\"sphere\"/><shape type=\"disk\"><emitter type=\"area\"/>"
               "</shape><shape type=\"rectangle\"><emitter type=\"directionalarea\"/>"
               "</shape>");
  ASSERT_EQ(scene->lights().size(), 3u);
  EXPECT_EQ(scene->surface(0).light, -1);
  EXPECT_EQ(scene->surface(1).light, 1);
  EXPECT_EQ(scene->lights()[1]->traits().shape, 1);
  // No ray meets a beam.
  EXPECT_EQ(scene->surface(2).light, -1);
  EXPECT_EQ(scene->lights()[2]->traits().beam_shape, 2);
}

/// Names that Mitsuba 0.6 wrote so, in a scene of a later version.
TEST(BuildScene, NamesInCamelCase) {
  const std::string placed =
      camera +
      "\n<shape type=\"sphere\"><transform name=\"toWorld\"><translate value=\"5, 0, 0\"/>"
      "</transform>";
  expect_one(lenient_warnings(placed + "</shape>"),
             "test.xml:3:22: 'toWorld' of shape 'sphere' is taken as 'to_world'");
  EXPECT_NEAR(scene_of(placed + "</shape>")->tracer().bounds().min.x, 4, 1e-5f);
  // What is given as it should be holds.
  expect_one(lenient_warnings(placed + "<transform name=\"to_world\"/></shape>"),
             "has no parameter 'toWorld': it is left out");
  EXPECT_NEAR(scene_of(placed + "<transform name=\"to_world\"/></shape>")->tracer().bounds().min.x,
              -1, 1e-5f);
}

TEST(BuildScene, TypesWithAWordMoreAreOfDialects) {
  expect_one(lenient_warnings("<sensor type=\"codedperspective\"/>" + sphere),
             "unknown sensor type 'codedperspective': 'perspective' is used instead");
  expect_problem("<sensor type=\"perspectivs\"/>" + sphere, "2:1",
                 "unknown sensor type 'perspectivs'", "did you mean 'perspective'?");
}

TEST(BuildScene, SurfacesOfDialects) {
  const auto reflected = [](const std::string& bsdf) {
    const std::string text = camera + "<shape type=\"sphere\">" + bsdf + "</shape>";
    expect_one(lenient_warnings(text), "Kaustik does not know bsdf");
    return scene_of(text)->surface(0).bsdf->albedo({}, {0, 0, 1}, Lobes::all)[0];
  };
  EXPECT_FLOAT_EQ(reflected("<bsdf type=\"itu-radio-material\"/>"), 0.5f);
  EXPECT_FLOAT_EQ(reflected("<bsdf type=\"skin9\"><rgb name=\"base_color\" value=\"0.2\"/></bsdf>"),
                  0.2f);
  EXPECT_FLOAT_EQ(reflected("<bsdf type=\"varnish\"><bsdf type=\"diffuse\"><rgb "
                            "name=\"reflectance\" value=\"0.3\"/></bsdf></bsdf>"),
                  0.3f);
}

// As in Mitsuba.
TEST(BuildScene, LampsWithoutABsdfAreBlack) {
  const std::string lamp = "<emitter type=\"area\"/></shape>";
  const auto albedo = [](const Scene& scene) {
    return scene.surface(0).bsdf->albedo({}, {0, 0, 1}, Lobes::all)[0];
  };
  EXPECT_EQ(albedo(*scene_of(camera + "<shape type=\"sphere\">" + lamp)), 0);
}

TEST(BuildScene, LampsOfNullLetLightPass) {
  const std::string text = camera +
                           "<shape type=\"sphere\"><bsdf type=\"null\"/>"
                           "<emitter type=\"area\"/></shape>";
  const auto scene = scene_of(text);
  EXPECT_TRUE(scene->warnings().empty());
  EXPECT_FALSE(scene->surface(0).traits.is_null);  // paths look at it
  EXPECT_EQ(scene->surface(0).bsdf->straight({}, {0, 0, 1})[0], 1);
}

// Mitsuba's: before the scene, so far away that its larger side fills 45 degrees.
TEST(BuildScene, CamerasThatNobodyPlaced) {
  const std::string box =
      "<shape type=\"cube\"><transform name=\"to_world\"><scale value=\"2, 1, 1\"/>"
      "<translate value=\"5, 6, 7\"/></transform></shape>";
  expect_one(lenient_warnings(box), "the scene has no camera");
  const auto scene = scene_of(box);
  const Vec3f position = scene->camera().traits().position;
  EXPECT_NEAR(position.x, 5, 1e-5);
  EXPECT_NEAR(position.y, 6, 1e-5);
  EXPECT_NEAR(position.z, 6 - 4 / (2 * std::tan(pi / 8)), 1e-4);
}

TEST(BuildScene, LightsThatCannotShine) {
  expect_problem(camera + "\n<shape type=\"sdf\"><emitter type=\"area\"/></shape>", "3:19",
                 "cannot be sampled by area");
}

TEST(BuildScene, MistakesInUnusedObjectsAreToldToo) {
  expect_problem(camera + sphere + "\n<bsdf type=\"difuse\"/>", "3:1", "unknown bsdf type",
                 "did you mean 'diffuse'?");
  expect_problem(camera + sphere + "\n<texture type=\"bitmp\"/>", "3:1", "unknown texture type",
                 "did you mean 'bitmap'?");
}

TEST(BuildScene, AllProblemsAreToldTogether) {
  const auto problems = problems_of(
      "<shape type=\"spere\"/>\n<shape type=\"sphere\"><float name=\"radius\" value=\"-1\"/>"
      "<bsdf type=\"difuse\"/></shape>");
  ASSERT_EQ(problems.size(), 3u);
  EXPECT_EQ(problems[0].place.line, 2);
  EXPECT_EQ(problems[1].place.line, 3);
}

TEST(BuildScene, CropWindowsMustLieInThePicture) {
  const auto cropped = [](const std::string& name, int value) {
    return "<sensor type=\"perspective\">\n" +
           film(64, 48,
                "<integer name=\"" + name + "\" value=\"" + std::to_string(value) + "\"/>") +
           "</sensor>" + sphere;
  };
  expect_problem(cropped("crop_width", 65), "3:1", "leaves the picture", "64×48");
  expect_problem(cropped("crop_offset_y", 48), "3:1", "leaves the picture", "64×48");
  EXPECT_EQ(scene_of(cropped("crop_width", 64))->film().crop_size, Vec2i(64, 48));
  EXPECT_EQ(scene_of(cropped("crop_offset_y", 47))->film().crop_size, Vec2i(64, 1));
}

TEST(BuildScene, ParametersWithoutEffectAreReportedOnce) {
  const std::string odd = "<shape type=\"sphere\"/>";
  const auto scene = scene_of(
      "<sensor type=\"perspective\"><float name=\"shutter_open\" value=\"0.1\"/>\n"
      "<float name=\"shutter_close\" value=\"9\"/></sensor>" +
      odd);
  ASSERT_EQ(scene->warnings().size(), 1u);
  EXPECT_EQ(scene->warnings()[0],
            "without effect here: 'shutter_close' of sensor 'perspective' (test.xml:3:1), "
            "'shutter_open' of sensor 'perspective' (test.xml:2:28)");
}

/// `levels` bsdfs, a line each, every one made of the one before, twice if `twice`.
std::string nested_bsdfs(const std::string& type, int levels, bool twice) {
  std::string text = "<bsdf type=\"diffuse\" id=\"b0\"/>\n";
  for (int i = 1; i <= levels; ++i) {
    const std::string nested = "<ref id=\"b" + std::to_string(i - 1) + "\"/>";
    text += "<bsdf type=\"" + type + "\" id=\"b" + std::to_string(i) + "\">" + nested +
            (twice ? nested : "") + "</bsdf>\n";
  }
  return text;
}

/// Two to the power of 60 answers for each question otherwise, while the scene is built, too.
TEST(BuildScene, BsdfsThatShareNestedOnesStayFew) {
  const std::string shape = "<shape type=\"sphere\"><ref id=\"b60\"/></shape>";
  expect_problem(camera + shape + "\n" + nested_bsdfs("blendbsdf", 60, true), "11:1",
                 "nests 510 bsdfs", "at most 255");
  // What asks one of its nested bsdfs at a time may share them.
  EXPECT_EQ(
      scene_of(camera + nested_bsdfs("twosided", 60, true) + shape)->surface(0).bsdf->traits().size,
      61);
  EXPECT_EQ(
      scene_of(camera + nested_bsdfs("mask", 60, false) + shape)->surface(0).bsdf->traits().size,
      61);
  const std::string seven = "<shape type=\"sphere\"><ref id=\"b7\"/></shape>";
  EXPECT_EQ(
      scene_of(camera + nested_bsdfs("blendbsdf", 7, true) + seven)->surface(0).bsdf->traits().size,
      255);
}

TEST(BuildScene, WhatMeshFilesLeaveOutIsReportedOnce) {
  const std::string path = testing::TempDir() + "kaustik_" + std::to_string(::getpid()) + ".obj";
  std::ofstream(path) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2\ntriangle 1 2 3\n";
  const std::string shape =
      "<shape type=\"obj\"><string name=\"filename\" value=\"" + path + "\"/></shape>";
  const auto scene = scene_of(any_camera + shape + shape);
  std::filesystem::remove(path);
  ASSERT_EQ(scene->warnings().size(), 2u);
  EXPECT_NE(scene->warnings()[0].find(":6: lines that begin with 'triangle'"), std::string::npos);
  EXPECT_NE(scene->warnings()[1].find("1 face was left out"), std::string::npos);
}

TEST(BuildScene, ErrorsWithoutAPlaceGetThatOfTheFileName) {
  expect_problem(camera + "<shape type=\"ply\">\n <string name=\"filename\" value=\".\"/></shape>",
                 "3:2", "not a regular file", "give the name of a file");
}

TEST(BuildScene, FilesThatAreNotThereLeaveStandIns) {
  const auto file = [](const std::string& name) {
    return "<string name=\"filename\" value=\"" + name + "\"/>";
  };
  const std::string mesh = camera + sphere + "\n<shape type=\"ply\">" + file("no.ply") +
                           "<emitter type=\"area\"/></shape>";
  expect_one(lenient_warnings(mesh), "3:19: there is no file 'no.ply': the shape is left out");
  EXPECT_EQ(scene_of(mesh)->surface_count(), 1u);
  EXPECT_TRUE(scene_of(mesh)->lights().empty());
  const std::string picture = camera +
                              "<shape type=\"rectangle\"><bsdf type=\"diffuse\"><texture "
                              "type=\"bitmap\" name=\"reflectance\">" +
                              file("no.png") + "</texture></bsdf></shape>";
  expect_one(lenient_warnings(picture), "no file 'no.png': a magenta checker stands for it");
  const Spectrum seen = scene_of(picture)->surface(0).bsdf->albedo({}, {0, 0, 1}, Lobes::all);
  EXPECT_FLOAT_EQ(seen[0], 0.8f);
  EXPECT_FLOAT_EQ(seen[1], 0);
  const std::string sky = camera + sphere + "<emitter type=\"envmap\">" + file("no.exr") +
                          "<float name=\"scale\" value=\"3\"/></emitter>";
  expect_one(lenient_warnings(sky), "no file 'no.exr': even light stands for it");
  EXPECT_EQ(scene_of(sky)->lights().size(), 1u);
  const std::string luminaire = camera + sphere + "<emitter type=\"goniometric\">" +
                                file("no.ies") + "<float name=\"scale\" value=\"2\"/></emitter>";
  expect_one(lenient_warnings(luminaire), "no file 'no.ies': a point of 1000 cd stands for it");
  EXPECT_NEAR(scene_of(luminaire)->lights()[0]->emitted({}, {0, 0, 1}, {})[1], 2000. / 179, 1e-4);
}

class CountingObserver final : public RayObserver {
 public:
  void on_ray(const Ray&, bool shadow) override { ++(shadow ? shadows : rays); }
  int rays = 0, shadows = 0;
};

TEST(BuildScene, ObserversSeeEveryRay) {
  CountingObserver observer;
  BuildOptions options;
  options.observer = &observer;
  const auto scene = build_scene(description_of(camera + sphere), options);
  Hit hit;
  scene->intersect({{0, 0, -9}, {0, 0, 1}}, hit);
  scene->occluded({{0, 0, -9}, {0, 0, 1}});
  scene->occluded({{0, 0, -9}, {0, 0, 1}});
  EXPECT_EQ(observer.rays, 1);
  EXPECT_EQ(observer.shadows, 2);
}

}  // namespace
}  // namespace kaustik
