#include "kaustik/render/photon_tracing.h"

#include <gtest/gtest.h>

#include "kaustik/loader/mitsuba_xml.h"
#include "kaustik/scene/scene.h"

namespace kaustik {
namespace {

Description described(const std::string& integrator, const std::string& ball = "dielectric") {
  return parse_mitsuba_xml(
      "<scene version=\"3.0.0\">" + integrator +
          "<sensor type=\"perspective\"/><emitter type=\"point\"><point name=\"position\" x=\"0\" "
          "y=\"0\" z=\"3\"/></emitter><shape type=\"sphere\"><point name=\"center\" x=\"0\" "
          "y=\"0\" z=\"1.5\"/><float name=\"radius\" value=\"0.5\"/><bsdf type=\"" +
          ball +
          "\"/></shape><shape type=\"cube\"><transform name=\"to_world\"><scale value=\"5\"/>"
          "</transform><boolean name=\"flip_normals\" value=\"true\"/></shape></scene>",
      "test.xml", "");
}

constexpr const char* photonmap =
    "<integrator type=\"photonmap\"><integer name=\"caustic_photons\" value=\"4000\"/>"
    "<integer name=\"global_photons\" value=\"3000\"/><integer name=\"max_light_level\" "
    "value=\"5\"/></integrator>";

TEST(PhotonTracing, FollowsTheIntegratorsParameters) {
  const Description description = described(photonmap);
  const auto scene = build_scene(description);
  const TracedPhotons traced = trace_photon_maps(description, *scene, 7, 0);
  EXPECT_TRUE(traced.warnings.empty());
  EXPECT_EQ(traced.photons.seed, 7u);
  EXPECT_EQ(traced.photons.settings.caustic_photons, 4000u);
  EXPECT_EQ(traced.photons.settings.global_photons, 3000u);
  EXPECT_EQ(traced.photons.settings.maximum_events, 5);
  EXPECT_TRUE(traced.photons.fingerprint.matches(fingerprint_of(*scene)));
  EXPECT_GT(traced.photons.maps.caustic.size(), 1000u);
  EXPECT_GT(traced.photons.maps.global.size(), 1000u);
}

TEST(PhotonTracing, FilesHoldRedGreenAndBlueAlone) {
  Description description = described(photonmap);
  for (const Child& child : description.scene->children)
    if (child.object->family == "sensor") {
      auto film = std::make_shared<Object>(Object{"film", "hdrfilm", "", {}, {}, {}});
      film->properties.push_back({"color", std::string("spectral"), {}});
      child.object->children.push_back({"", film});
    }
  const auto scene = build_scene(description);
  ASSERT_TRUE(scene->film().is_spectral);
  EXPECT_THROW(trace_photon_maps(description, *scene, 7, 0), Error);
}

TEST(PhotonTracing, AnotherIntegratorStaysAndDefaultsServe) {
  const Description description =
      described("<integrator type=\"path\"><integer name=\"max_depth\" value=\"4\"/></integrator>");
  const auto scene = build_scene(description);
  const TracedPhotons traced = trace_photon_maps(description, *scene, 0, 0);
  EXPECT_EQ(find_integrator(description)->type, "path");
  EXPECT_EQ(find_integrator(description)->properties.size(), 1u);
  EXPECT_GT(traced.photons.maps.global.size(), 1000u);
}

TEST(PhotonTracing, ThreadsMakeNoDifference) {
  const Description description = described(photonmap);
  const auto scene = build_scene(description);
  const PhotonMaps one = trace_photon_maps(description, *scene, 7, 1).photons.maps;
  const PhotonMaps two = trace_photon_maps(description, *scene, 7, 2).photons.maps;
  ASSERT_EQ(one.caustic.size(), two.caustic.size());
  ASSERT_EQ(one.global.size(), two.global.size());
  for (uint32_t i = 0; i < one.caustic.size(); ++i) {
    EXPECT_EQ(one.caustic.tree().key(i), two.caustic.tree().key(i));
    EXPECT_EQ(one.caustic.tree().data(i).flux.lanes, two.caustic.tree().data(i).flux.lanes);
  }
}

TEST(PhotonTracing, StoppedIsAnError) {
  const Description description = described(photonmap);
  const auto scene = build_scene(description);
  std::stop_source source;
  source.request_stop();
  try {
    trace_photon_maps(description, *scene, 7, 0, source.get_token());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::system);
  }
}

TEST(PhotonTracing, EmptyMapsAreExplained) {
  const Description plain = described(photonmap, "diffuse");
  const TracedPhotons traced = trace_photon_maps(plain, *build_scene(plain), 7, 0);
  ASSERT_EQ(traced.warnings.size(), 1u);
  EXPECT_NE(traced.warnings[0].find("no specular object"), std::string::npos);
}

TEST(PhotonTracing, WrongParametersAreRefused) {
  Description wrong = described(
      "<integrator type=\"photonmap\"><integer name=\"caustic_photon\" value=\"1\"/></integrator>");
  EXPECT_NO_THROW(trace_photon_maps(wrong, *build_scene(wrong), 7, 0));
  const auto scene = build_scene(wrong);
  wrong.is_strict = true;
  EXPECT_THROW(trace_photon_maps(wrong, *scene, 7, 0), Error);
}

/// Photons don't know the surfaces' own models: maps that these want may be the ones to be made.
TEST(PhotonTracing, ModelsOfSurfacesDoNotMatter) {
  const Description description =
      described(std::string(photonmap) +
                "<shape type=\"sphere\"><integrator type=\"photonmap\"><string "
                "name=\"photon_map\" value=\"missing.kpm\"/></integrator></shape>");
  const auto scene = build_scene(description);
  EXPECT_GT(trace_photon_maps(description, *scene, 7, 0).photons.maps.global.size(), 1000u);
}

}  // namespace
}  // namespace kaustik
