// What other renderers call otherwise, and scenes without shapes.

#include "kaustik/integrator/foreign_integrators.h"
#include "kaustik/integrator/make_integrator.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

/// Whatever is told of the method.
Passes rendered(const TestScene& scene, const std::string& type, const std::string& parameters,
                const RenderOptions& options) {
  const Description description =
      parse_mitsuba_xml("<scene version=\"3.0.0\"><integrator type=\"" + type + "\">" + parameters +
                            "</integrator></scene>",
                        "test", "");
  std::vector<std::string> warnings;
  const auto integrator = make_integrator(*find_integrator(description), scene.scene(), warnings);
  return render(scene, *integrator, options);
}

TEST(ForeignIntegrators, MakeTheSameBits) {
  const TestScene scene(
      camera("0, -2.2, 1.3", "0, 0.2, 0.35", 48, 12) + flat("rectangle", "", phong(0.4, 0.3, 20)) +
      flat("rectangle", rotate("1, 0, 0", 90) + translate("0, 1, 1"), diffuse("0.5, 0.3, 0.2")) +
      sphere("-0.45, 0.3, 0.401", 0.4, mirror()) +
      sphere("0, 0.1, 1.4", 0.2, diffuse("0") + area_light("10, 9, 8")));
  struct Pair {
    std::string theirs, their_parameters, ours, our_parameters;
  };
  for (const Pair& pair :
       {Pair{"volpath", set("max_depth", 4) + set("rr_depth", 3), "path",
             set("max_depth", 4) + set("rr_depth", 3)},
        Pair{"volpathmis", set("use_spectral_mis", true), "path", ""},
        Pair{"volpath_simple", set("strict_normals", true), "path", ""},
        Pair{"direct", set("emitter_samples", 4) + set("bsdf_samples", 2), "path",
             set("max_depth", 2)},
        Pair{"bdpt", set("light_image", false), "bdpt", set("splats", false)},
        Pair{"sppm", set("initial_radius", 0.05) + set("max_depth", 4), "ppm",
             set("radius", 0.05) + set("max_depth", 4)},
        Pair{"photonmapper",
             set("lookup_size", 12) + set("global_photons", 3000) + set("max_depth", 9),
             "photonmap",
             set("caustic_neighbors", 12) + set("global_neighbors", 12) +
                 set("global_photons", 3000)},
        Pair{"aov",
             "<string name=\"aovs\" value=\"d:depth\"/><integrator type=\"path\">" +
                 set("max_depth", 3) + "</integrator>",
             "path", set("max_depth", 3)},
        Pair{"ptracer", set("max_depth", 4) + set("samples_per_pass", 4) + set("rr_depth", 5),
             "lighttracer", set("max_depth", 4)}}) {
    SCOPED_TRACE(pair.theirs);
    const RenderOptions options{4, 1, 2, 1};
    const Passes ours = rendered(scene, pair.ours, pair.our_parameters, options);
    EXPECT_TRUE(same_bits(rendered(scene, pair.theirs, pair.their_parameters, options), ours));
    EXPECT_GT(ours.mean({""}).mean(), 0);
    // What it is called here makes a difference, or the comparison would show nothing.
    EXPECT_FALSE(
        same_bits(rendered(scene, pair.theirs, pair.their_parameters, {4, 2, 2, 1}), ours));
  }
}

Object described(const std::string& type, const std::string& contents) {
  return *find_integrator(parse_mitsuba_xml("<scene version=\"3.0.0\"><integrator type=\"" + type +
                                                "\">" + contents + "</integrator></scene>",
                                            "test", ""));
}

const Property* property_of(const Object& object, const std::string& name) {
  for (const Property& property : object.properties)
    if (property.name == name) return &property;
  return nullptr;
}

TEST(ForeignIntegrators, AreToldOnce) {
  const TestScene scene(camera("0, -2, 1", "0, 0, 0", 40, 4) + flat("rectangle", "", diffuse("1")));
  std::vector<std::string> warnings;
  const Object direct{"integrator", "direct", "", {}, {}, {}};
  make_integrator(direct, scene.scene(), warnings);
  make_integrator(direct, scene.scene(), warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0], "integrator 'direct' is called path with max_depth = 2 here");
}

/// Every name of the table becomes a type of Kaustik's that the parameters are known to.
TEST(ForeignIntegrators, AllBecomeOurOwn) {
  const TestScene scene(camera("0, -2, 1", "0, 0, 0", 40, 4) + flat("rectangle", "", diffuse("1")));
  for (const ForeignIntegrator& foreign : foreign_integrators())
    for (const std::string& name : foreign.names) {
      SCOPED_TRACE(name);
      EXPECT_EQ(find_foreign_integrator(name), &foreign);  // in one row only
      const Object object = described(name, "");
      std::vector<std::string> notes;
      if (!foreign.refusal.empty()) {
        EXPECT_THROW(native_integrator(object, notes), Error);
        continue;
      }
      EXPECT_EQ(native_integrator(object, notes).type, native_type(object));
      ASSERT_NE(find_integrator_type(native_type(object)), nullptr);
      EXPECT_EQ(notes.empty(), find_integrator_type(name) != nullptr);
      EXPECT_NE(make_integrator(object, scene.scene(), notes), nullptr);
      for (const auto& [theirs, ours] : foreign.renamed) {
        EXPECT_NE(foreign.info.find(theirs), nullptr) << theirs;
        EXPECT_NE(find_integrator_type(foreign.native)->info.find(ours), nullptr) << ours;
      }
    }
}

TEST(ForeignIntegrators, KeepWhatHasAMeaning) {
  std::vector<std::string> notes;
  const Object object = native_integrator(
      described("pssmlt", set("max_depth", 7) + set("luminance_samples", 9)), notes);
  EXPECT_EQ(object.type, "auto");
  ASSERT_EQ(object.properties.size(), 1u);
  EXPECT_EQ(object.properties[0].value, Value(int64_t{7}));
  EXPECT_EQ(notes,
            (std::vector<std::string>{
                "without effect here: 'luminance_samples' of integrator 'pssmlt' (test:1:87)",
                "there is no integrator 'pssmlt' here: auto renders the picture"}));
  // What is said in our words wins.
  const Object both =
      native_integrator(described("sppm", set("initial_radius", 2.0) + set("radius", 3.0)), notes);
  ASSERT_EQ(both.properties.size(), 1u);
  EXPECT_EQ(both.properties[0].value, Value(3.0));
  // `direct` says how long paths are, unless somebody says otherwise.
  const Object longer = native_integrator(described("direct", set("max_depth", 5)), notes);
  EXPECT_EQ(property_of(longer, "max_depth")->value, Value(int64_t{5}));
}

TEST(ForeignIntegrators, HoldersGiveWayToTheFirstThatShowsLight) {
  std::vector<std::string> notes;
  Object holder = described(
      "multichannel",
      "<integrator type=\"field\"/><integrator type=\"moment\"><integrator type=\"prbvolpath\">" +
          set("max_depth", 4) + "</integrator></integrator><integrator type=\"bdpt\"/>");
  holder.properties.push_back({"rr_depth", Untyped{"3"}, place_in("command line")});
  const Object inner = native_integrator(holder, notes);
  EXPECT_EQ(inner.type, "path");
  EXPECT_EQ(property_of(inner, "max_depth")->value, Value(int64_t{4}));
  EXPECT_EQ(property_of(inner, "rr_depth")->value, Value(Untyped{"3"}));
  ASSERT_EQ(notes.size(), 4u);  // two holders, what is left out, another name
  EXPECT_NE(notes[1].find("2 after 'moment' are left out"), std::string::npos) << notes[1];
}

TEST(ForeignIntegrators, WrongParametersAreNamedAsTheFileNamesThem) {
  std::vector<std::string> notes;
  const auto refusal = [&](const std::string& type, const std::string& contents) -> std::string {
    try {
      native_integrator(described(type, contents), notes);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_NE(refusal("photonmapper", set("lookup_size", -5)).find("'lookup_size' is -5"),
            std::string::npos);
  EXPECT_NE(refusal("volpath", set("maximum_depth", 3)).find("did you mean 'max_depth'"),
            std::string::npos);
  EXPECT_NE(refusal("depth", "").find("depth.Z"), std::string::npos);
  EXPECT_NE(refusal("aov", "<bsdf type=\"diffuse\"/>").find("cannot hold a bsdf"),
            std::string::npos);
}

/// The camera sees nothing but the environment, which is the same everywhere.
TEST(ScenesWithoutShapes, ShowTheirEnvironment) {
  const TestScene scene(camera("3, -2, 1", "0, 0, 0", 40, 4) + constant_light(2.5));
  const TestScene lamp(camera("3, -2, 1", "0, 0, 0", 40, 4) + point_light("0, 0, 0", 5));
  const TestScene nothing(camera("3, -2, 1", "0, 0, 0", 40, 4));
  for (const IntegratorType& type : integrator_types()) {
    SCOPED_TRACE(type.info.name);
    const bool sees = type.info.name != "lighttracer";
    EXPECT_NEAR(rendered(scene, type.info.name, "", {4, 1, 1}).mean({""}).mean(), sees ? 2.5 : 0,
                1e-5);
    EXPECT_EQ(rendered(lamp, type.info.name, "", {4, 1, 1}).mean({""}).mean(), 0);
    EXPECT_EQ(rendered(nothing, type.info.name, "", {4, 1, 1}).mean({""}).mean(), 0);
  }
}

// Research renderers have methods of their own, which change no light.
TEST(ForeignIntegrators, OfDialectsTheDefaultStandsForThem) {
  std::vector<std::string> notes;
  const Object unknown = described("restirgi", set("max_depth", 4) + set("reservoirs", 9));
  const Object stand_in = native_integrator(unknown, notes, false);
  EXPECT_EQ(stand_in.type, default_integrator);
  EXPECT_EQ(native_type(unknown), default_integrator);
  EXPECT_EQ(stand_in.properties.size(), 2u);  // what nobody knows of them is told where it is made
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("nobody knows integrator 'restirgi'"), std::string::npos);
  // A known name with a word more is no slip of the pen.
  EXPECT_EQ(native_integrator(described("ptracer_c", ""), notes, false).type, default_integrator);
  EXPECT_EQ(native_integrator(described("photon_map", ""), notes, false).type, "photon_map");
  // The one in it, by its own name here.
  const Object holder = described("guidedsdtree", "<integrator type=\"volpath\"/>");
  EXPECT_EQ(native_integrator(holder, notes, false).type, "path");
  EXPECT_EQ(native_type(holder), "path");
  // A slip of the pen, and what is read strictly, stay as they are: errors.
  EXPECT_EQ(native_integrator(described("photon_map", ""), notes, false).type, "photon_map");
  EXPECT_EQ(native_integrator(unknown, notes, true).type, "restirgi");
  Object typed = unknown;
  typed.place = place_in("integrator");
  EXPECT_EQ(native_integrator(typed, notes, false).type, "restirgi");
}

TEST(ForeignIntegrators, SamplersInIntegratorsHaveNoEffect) {
  const TestScene scene(camera("0, -2.2, 1.3", "0, 0.2, 0.35", 48, 12) + flat("rectangle", "", ""));
  const Object object = described("path", "<sampler type=\"independent\"/>");
  std::vector<std::string> warnings;
  make_integrator(object, scene.scene(), warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0], "the sampler in integrator 'path' has no effect: put it into the sensor");
  EXPECT_THROW(make_integrator(object, scene.scene(), warnings, true), Error);
}

TEST(ForeignIntegrators, WhatHoldsNoneLeavesItOut) {
  const TestScene scene(camera("0, -2.2, 1.3", "0, 0.2, 0.35", 48, 12) + flat("rectangle", "", ""));
  const Object object = described("path", "<integrator type=\"direct\"/>");
  std::vector<std::string> warnings;
  make_integrator(object, scene.scene(), warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0], "integrator 'path' holds none: 'direct' in it is left out");
  EXPECT_THROW(make_integrator(object, scene.scene(), warnings, true), Error);
}

}  // namespace
}  // namespace kaustik
