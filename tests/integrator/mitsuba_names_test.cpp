// What Mitsuba calls otherwise, and scenes without shapes.

#include "kaustik/integrator/make_integrator.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

bool same_bits(const Passes& a, const Passes& b) {
  for (size_t i = 0; i < a.images().size(); ++i)
    for (int c = 0; c < a.images()[i].channel_count(); ++c) {
      const auto x = a.images()[i].channel(c), y = b.images()[i].channel(c);
      if (std::memcmp(x.data(), y.data(), x.size_bytes()) != 0) return false;
    }
  return true;
}

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

TEST(MitsubaNames, MakeTheSameBits) {
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

TEST(MitsubaNames, AreToldOnce) {
  const TestScene scene(camera("0, -2, 1", "0, 0, 0", 40, 4) + flat("rectangle", "", diffuse("1")));
  std::vector<std::string> warnings;
  const Object direct{"integrator", "direct", "", {}, {}, {}};
  make_integrator(direct, scene.scene(), warnings);
  make_integrator(direct, scene.scene(), warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0], "integrator 'direct' is called path with max_depth = 2 here");
}

/// The camera sees nothing but the environment, which is the same everywhere.
TEST(ScenesWithoutShapes, ShowTheirEnvironment) {
  const TestScene scene(camera("3, -2, 1", "0, 0, 0", 40, 4) + constant_light(2.5));
  const TestScene lamp(camera("3, -2, 1", "0, 0, 0", 40, 4) + point_light("0, 0, 0", 5));
  const TestScene nothing(camera("3, -2, 1", "0, 0, 0", 40, 4));
  for (const IntegratorType& type : integrator_types()) {
    SCOPED_TRACE(type.info.name);
    const bool sees = type.info.name != "lighttracer" && type.info.name != "ptracer";
    EXPECT_NEAR(rendered(scene, type.info.name, "", {4, 1, 1}).mean({""}).mean(), sees ? 2.5 : 0,
                1e-5);
    EXPECT_EQ(rendered(lamp, type.info.name, "", {4, 1, 1}).mean({""}).mean(), 0);
    EXPECT_EQ(rendered(nothing, type.info.name, "", {4, 1, 1}).mean({""}).mean(), 0);
  }
}

}  // namespace
}  // namespace kaustik
