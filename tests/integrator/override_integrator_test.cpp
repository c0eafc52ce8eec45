#include "kaustik/integrator/override_integrator.h"

#include <gtest/gtest.h>

#include "kaustik/loader/mitsuba_xml.h"
#include "kaustik/scene/overrides.h"
#include "kaustik/scene/scene.h"

namespace kaustik {
namespace {

Description scene_with(const std::string& described_integrator) {
  return parse_mitsuba_xml("<scene version=\"3.0.0\">" + described_integrator + "</scene>", "test",
                           "");
}

std::string integer(const std::string& name, const std::string& value) {
  return "<integer name=\"" + name + "\" value=\"" + value + "\"/>";
}

std::string described_integrator(const std::string& type, const std::string& contents) {
  return "<integrator type=\"" + type + "\">" + contents + "</integrator>";
}

std::vector<std::string> names_of(const Description& description) {
  std::vector<std::string> names;
  for (const Property& property : find_integrator(description)->properties)
    names.push_back(property.name);
  return names;
}

using Names = std::vector<std::string>;

TEST(OverrideIntegrator, SameTypeStaysAsItIs) {
  Description description = scene_with(described_integrator("path", integer("max_depth", "3")));
  EXPECT_EQ(override_integrator(description, "path"), "");
  EXPECT_EQ(names_of(description), Names{"max_depth"});
}

TEST(OverrideIntegrator, KeepsWhatBothHave) {
  Description description = scene_with(described_integrator(
      "vcm", integer("max_depth", "3") + integer("rr_depth", "2") +
                 integer("merge_neighbors", "9") + integer("samples_per_pass", "8")));
  EXPECT_EQ(override_integrator(description, "path"),
            "integrator 'path' has no use for what the scene says of its 'vcm': merge_neighbors, "
            "samples_per_pass");
  EXPECT_EQ(find_integrator(description)->type, "path");
  EXPECT_EQ(names_of(description), (Names{"max_depth", "rr_depth"}));
  override_property(description, "integrator.max_depth=5");
  EXPECT_EQ(names_of(description), (Names{"rr_depth", "max_depth"}));
}

/// What has no effect in the one must not get one in the other.
TEST(OverrideIntegrator, IgnoredParametersGoInSilence) {
  Description description =
      scene_with(described_integrator("path", integer("samples_per_pass", "64")));
  EXPECT_EQ(override_integrator(description, "vcm"), "");
  EXPECT_EQ(names_of(description), Names{});
}

TEST(OverrideIntegrator, ValuesThatTheNewOneRefusesGo) {
  Description description =
      scene_with(described_integrator("photonmap", integer("samples_per_pass", "0")));
  EXPECT_NE(override_integrator(description, "vcm").find("samples_per_pass"), std::string::npos);
  EXPECT_EQ(names_of(description), Names{});
}

TEST(OverrideIntegrator, SpeaksOtherRenderersWords) {
  Description held = scene_with(described_integrator(
      "aov", "<string name=\"aovs\" value=\"d:depth\"/>" +
                 described_integrator("prbvolpath", integer("max_depth", "4"))));
  EXPECT_EQ(override_integrator(held, "vcm"), "");
  EXPECT_EQ(names_of(held), Names{"max_depth"});
  EXPECT_TRUE(find_integrator(held)->children.empty());

  Description photons =
      scene_with(described_integrator("photonmapper", integer("lookup_size", "40")));
  EXPECT_EQ(override_integrator(photons, "photonmap"), "");
  EXPECT_EQ(names_of(photons), (Names{"global_neighbors", "caustic_neighbors"}));

  // What a type means by itself is no wish of the file's …
  Description direct = scene_with(described_integrator("direct", integer("rr_depth", "7")));
  EXPECT_EQ(override_integrator(direct, "path"), "");
  EXPECT_EQ(names_of(direct), Names{"rr_depth"});
  // … and wins over the file's.
  Description longer = scene_with(described_integrator("path", integer("max_depth", "7")));
  EXPECT_NE(override_integrator(longer, "direct").find("max_depth"), std::string::npos);
  EXPECT_EQ(names_of(longer), Names{});
}

TEST(OverrideIntegrator, UnknownOnesAreReplaced) {
  Description description = scene_with(
      described_integrator("strange", integer("max_depth", "4") + integer("tentacles", "8")));
  EXPECT_EQ(override_integrator(description, "path"),
            "integrator 'path' has no use for what the scene says of its 'strange': tentacles");
  EXPECT_EQ(names_of(description), Names{"max_depth"});
}

/// What is said of the scene's integrator leaves a shape alone that refers to it.
TEST(OverrideIntegrator, IntegratorsOfShapesStay) {
  Description description = scene_with(
      "<integrator type=\"localphong\" id=\"plain\"><float name=\"ambient\" value=\"0.5\"/>"
      "</integrator><shape type=\"sphere\"><ref id=\"plain\"/></shape>");
  override_integrator(description, "path");
  EXPECT_EQ(find_integrator(description)->type, "path");
  const Object& shape = *description.scene->children.back().object;
  ASSERT_EQ(shape.children.size(), 1u);
  EXPECT_EQ(shape.children[0].object->type, "localphong");
  EXPECT_EQ(shape.children[0].object->properties.size(), 1u);
}

}  // namespace
}  // namespace kaustik
