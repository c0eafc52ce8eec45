// The grammar of Radiance's scenes: primitives, aliases, comments, commands, and what is wrong.
#include "radiance_support.h"

namespace kaustik::radiance_test {
namespace {

TEST(RadianceStatements, PrimitivesInAnyLayout) {
  const auto scene = parse_rad(
      "# a comment\nvoid plastic \"my paint\"\n0\n0\n5 .1 .2 .3 0 0 # behind\n\n"
      "\"my paint\" sphere ball 0 0 4\n\t1 2\n3 .5\n");
  const Object& ball = sole_object(scene, "shape");
  EXPECT_EQ(ball.type, "sphere");
  EXPECT_EQ(value<Vec3d>(ball, "center"), Vec3d(1, 2, 3));
  EXPECT_EQ(value<double>(ball, "radius"), 0.5);
  expect_colour(front_bsdf(ball), "reflectance", .1, .2, .3);
  EXPECT_EQ(text_of(ball.place), "test.rad:7:1");
}

TEST(RadianceStatements, TheLastDefinitionBeforeItsUseCounts) {
  const auto scene = parse_rad(
      "void plastic a 0 0 5 .1 .1 .1 0 0\na sphere s1 0 0 4 0 0 0 1\n"
      "void plastic a 0 0 5 .9 .9 .9 0 0\na sphere s2 0 0 4 5 0 0 1\n");
  const auto balls = rad_objects(scene, "shape");
  ASSERT_EQ(balls.size(), 2u);
  expect_colour(front_bsdf(*balls[0]), "reflectance", .1, .1, .1);
  expect_colour(front_bsdf(*balls[1]), "reflectance", .9, .9, .9);
}

TEST(RadianceStatements, AliasesStandForWhatIsKnown) {
  const auto scene =
      parse_rad("void plastic a 0 0 5 .1 .1 .1 0 0\nvoid alias b a\nb sphere s 0 0 4 0 0 0 1\n");
  expect_colour(front_bsdf(sole_object(scene, "shape")), "reflectance", .1, .1, .1);
}

TEST(RadianceStatements, AliasesMayHaveAnotherModifier) {
  const std::string paint = "void brightfunc half 2 .5 . 0 0\nhalf plastic a 0 0 5 .8 .8 .8 0 0\n";
  const auto reflectance = [&](const std::string& alias) {
    return colour_in(front_bsdf(sole_object(
                         parse_rad(paint + alias + "\nb sphere s 0 0 4 0 0 0 1\n"), "shape")),
                     "reflectance")
        ->r;
  };
  EXPECT_NEAR(reflectance("inherit alias b a"), .4, 1e-9);
  EXPECT_NEAR(reflectance("half alias b a"), .4, 1e-9);
  EXPECT_NEAR(reflectance("void alias b a"), .8, 1e-9);
}

TEST(RadianceStatements, MaterialsOfFilesThatAreNotThereAreGrey) {
  const auto scene =
      parse_rad("oak1 polygon p 0 0 9 0 0 0 1 0 0 1 1 0\noak2 sphere s 0 0 4 0 0 0 1\n");
  EXPECT_TRUE(tells(scene, DeviationKind::missing, "modifier 'oak1'", "grey paint"));
  EXPECT_TRUE(tells(scene, DeviationKind::missing, "modifier 'oak2'", "grey paint"));
  for (const Object* shape : rad_objects(scene, "shape"))
    expect_colour(front_bsdf(*shape), "reflectance", .5, .5, .5);
}

TEST(RadianceStatements, PolygonsOfOneMaterialAreOneMesh) {
  const auto scene = parse_rad(grey + square + "grey polygon p2 0 0 9 0 0 1 1 0 1 0 1 1\n");
  EXPECT_EQ(rad_numbers(sole_object(scene, "shape"), "faces").size(), 9u);
}

void expect_wrong(const std::string& text, const std::string& place, const std::string& message,
                  const std::string& remedy) {
  SCOPED_TRACE(text);
  expect_problem(problems_of([&] { parse_rad(text); }), place, message, remedy);
}

TEST(RadianceErrors, HaveAPlaceAndARemedy) {
  expect_wrong("void plastik a 0 0 0", "test.rad:1:6", "no primitive of type 'plastik'",
               "did you mean 'plastic'");
  expect_wrong(grey + "grey sphere s 0 0 4 0 0 x 1", "test.rad:2:25", "'x' stands where a number",
               "such as 0.5");
  expect_wrong(grey + "grey sphere s 0 0 3 0 0 0", "test.rad:2:1", "has 3 numbers where 4",
               "correct the arguments");
  expect_wrong(grey + "gray sphere s 0 0 4 0 0 0 1", "test.rad:2:1", "no modifier 'gray'",
               "did you mean 'grey'");
  expect_wrong("void plastic a 0 0 500 1 1", "test.rad:1:20", "500 is more than the rest",
               "correct the count");
  expect_wrong(grey + "grey polygon p 0 0 9 0 0 0 1", "test.rad:2:20", "9 is more than the rest",
               "correct the count");
  expect_wrong(grey + "grey polygon", "test.rad:2:12", "the file ends where", "cut off");
  expect_wrong(grey + "grey polygon p 0 0 8 0 0 0 1 0 0 1 1", "test.rad:2:1", "no corners",
               "three numbers");
}

TEST(RadianceErrors, NumbersOutOfAllBounds) {
  const std::string light = "void light l 0 0 3 1 1 1\n";
  EXPECT_TRUE(tells(parse_rad(light + "l source s 0 0 4 0 0 -1e308 .5\n"), DeviationKind::ignored,
                    "source 's'"));
  EXPECT_TRUE(tells(parse_rad(grey + "!genbox grey b 1 1 1 | xform -s 1e200 -s 1e200\n"),
                    DeviationKind::ignored, "polygon 'b.1'", "no area"));
}

TEST(RadianceErrors, CommandsAreNeverRun) {
  expect_wrong("!rm -f x\n", "test.rad:1:1", "'rm', which is not built in", "xform -e scene.rad");
  expect_wrong("!genbox a b 1 1 1; touch x\n", "test.rad:1:1", "has a ';'", "not run");
  expect_wrong("!genbox a b 1 1 1 > x\n", "test.rad:1:1", "has a '>'", "xform -e");
  expect_wrong("!xform `ls` x.rad\n", "test.rad:1:1", "has a '`'", "xform -e");
  expect_wrong("!xform -t 1 x 2 a.rad\n", "test.rad:1:1", "'x' stands where 'xform' expects",
               "xform [-t x y z]");
  expect_wrong("!genbox a b 1 1\n", "test.rad:1:1", "too few arguments", "genbox material name");
}

TEST(RadianceErrors, PartsThatAreMissingAreLeftOut) {
  const Description scene = parse_rad("!xform -t 1 2 3 none.rad\n" + grey +
                                      "grey sphere s 0 0 4 0 0 0 1\n!xform nor.rad\n");
  EXPECT_TRUE(tells(scene, DeviationKind::missing, "file none.rad", "no such file"));
  EXPECT_TRUE(tells(scene, DeviationKind::missing, "file nor.rad", "no such file"));
  EXPECT_EQ(sole_object(scene, "shape").type, "sphere");
  LoadOptions strict;
  strict.is_strict = true;
  EXPECT_THROW(parse_rad("!xform none.rad\n", strict), Error);
}

TEST(RadianceErrors, FilesCannotIncludeThemselves) {
  TemporaryFolder folder;
  const std::string a = folder.write("a.rad", "!xform b.rad\n");
  folder.write("b.rad", "!xform -t 1 0 0 a.rad\n");
  const auto problems = problems_of([&] { load_radiance(a); });
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].message.find("includes itself"), std::string::npos);
  EXPECT_EQ(text_of(problems[0].place), (folder / "b.rad") + ":1:1");
}

TEST(RadianceErrors, OtherFilesAreNotQuoted) {
  TemporaryFolder folder;
  folder.write("secret", "user: 123\npassword 4 5 6\n");
  const std::string scene = folder.write("a.rad", "!xform secret\n");
  try {
    load_radiance(scene);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).find("password"), std::string::npos) << error.what();
  }
}

TEST(RadianceErrors, IncludesThatMultiplyAreBounded) {
  TemporaryFolder folder;
  std::string last = "x0.rad";
  folder.write(last, grey + "grey sphere s 0 0 4 0 0 0 1\n");
  for (int i = 1; i < 40; ++i) {
    const std::string next = "x" + std::to_string(i) + ".rad";
    folder.write(next, "!xform " + last + "\n!xform -t 1 0 0 " + last + "\n");
    last = next;
  }
  const auto problems = problems_of([&] { load_radiance(folder / last); });
  EXPECT_NE(problems[0].message.find("more than"), std::string::npos) << problems[0].message;
}

TEST(RadianceErrors, StrictMakesErrorsOfDeviations) {
  LoadOptions strict;
  strict.is_strict = true;
  const auto problems = problems_of([&] { parse_rad(grey + square, strict); });
  ASSERT_EQ(problems.size(), 2u);
  EXPECT_NE(problems[0].message.find("camera"), std::string::npos) << problems[0].message;
  EXPECT_NE(problems[1].message.find("light"), std::string::npos) << problems[1].message;
}

}  // namespace
}  // namespace kaustik::radiance_test
