// What scene files may lack or hold beside what they need.

#include "tests/loader/loader_support.h"

namespace kaustik {
namespace {

LoadOptions strict() {
  LoadOptions options;
  options.is_strict = true;
  return options;
}

// Who refers to something that is left out does without it, under its own id or an alias.
TEST(LoaderLeniency, ReferencesToWhatIsLeftOut) {
  for (const std::string left_out :
       {"<subsurface type='dipole' id='ss'/>", "<glow id='ss'/>",
        "<glow><bsdf type='diffuse' id='ss'/></glow>",
        "<glow id='x'/><alias id='x' as='y'/><alias id='y' as='ss'/>"}) {
    SCOPED_TRACE(left_out);
    const std::string text =
        in_scene(left_out +
                     "<bsdf type='diffuse' id='grey'/><shape type='sphere'><ref id='ss'/>"
                     "<ref id='grey'/><ref name='again' id='ss'/></shape>",
                 "0.6.0");
    const Description description = parse(text);
    const Object& shape = *description.scene->children.at(1).object;
    ASSERT_EQ(shape.children.size(), 1u);
    EXPECT_EQ(shape.children[0].object->id, "grey");
    EXPECT_FALSE(problems_in(text, strict()).empty());
  }
  // What was never there is an error still.
  expect_problem(problems_in(in_scene("<glow id='a'/><shape type='sphere'><ref id='b'/></shape>")),
                 "test.xml:2:36", "no object has the id 'b'", "");
}

TEST(LoaderLeniency, AttributesOfOtherPrograms) {
  const std::string text = in_scene("<bsdf type='diffuse' shader='x'/>");
  const Description description = parse(text);
  EXPECT_EQ(description.scene->children.size(), 1u);
  EXPECT_EQ(description.warnings,
            std::vector<std::string>{"test.xml:2:22: Kaustik does not know the attribute 'shader' "
                                     "of <bsdf>: it is left out"});
  expect_problem(problems_in(text, strict()), "test.xml:2:22", "no attribute 'shader'", "");
}

// Names of Mitsuba 2.
TEST(LoaderLeniency, LimitsOfCurvesByTheirOldNames) {
  const Description description =
      parse(in_scene("<spectrum type='regular' id='a'><float name='lambda_min' value='400'/>"
                     "<float name='lambda_max' value='700'/></spectrum>",
                     "2.0.0"));
  const Object& curve = *description.scene->children.at(0).object;
  EXPECT_EQ(value<double>(curve, "wavelength_min"), 400);
  EXPECT_EQ(value<double>(curve, "wavelength_max"), 700);
}

// Mitsuba 3 calls the parameters of the filter A and B.
TEST(LoaderLeniency, NamesOfMitchellsParameters) {
  const Description description =
      parse(in_scene("<rfilter type='mitchell' id='a'><float name='B' value='0.1'/>"
                     "<float name='A' value='0.2'/></rfilter>"
                     "<rfilter type='mitchell' id='b'><float name='B' value='0.1'/></rfilter>"));
  const Object& both = *description.scene->children.at(0).object;
  EXPECT_EQ(value<double>(both, "B"), 0.2);
  EXPECT_EQ(value<double>(both, "C"), 0.1);
  EXPECT_EQ(value<double>(*description.scene->children.at(1).object, "B"), 0.1);
}

TEST(LoaderLeniency, RotationsWithoutAnAxis) {
  const std::string text = in_scene(
      "<shape type='sphere'><transform name='x'><rotate x='0' y='0' z='0' angle='30'/>"
      "<translate x='1'/></transform></shape>");
  const Description description = parse(text);
  EXPECT_EQ(value<Transform>(*description.scene->children.at(0).object, "x"),
            Transform::translate({1, 0, 0}));
  ASSERT_EQ(description.warnings.size(), 1u);
  EXPECT_NE(description.warnings[0].find("turns nothing"), std::string::npos);
  EXPECT_FALSE(problems_in(text, strict()).empty());
}

}  // namespace
}  // namespace kaustik
