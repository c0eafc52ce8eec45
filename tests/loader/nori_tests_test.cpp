// The claims of Nori's files of tests.

#include "kaustik/base/statistics.h"
#include "kaustik/loader/object_parts.h"
#include "tests/loader/nori_support.h"

namespace kaustik::nori {
namespace {

std::vector<NoriTest> read_claims(const std::string& text) {
  const TemporaryFolder folder;
  return read_nori_tests(folder.write("test.xml", text));
}

const std::string scene_of_claims = "<scene><integrator type=\"path\"/>" + nori_camera + "</scene>";

TEST(NoriTests, ScenesWithReferences) {
  const auto claims = read_claims(
      "<test type=\"ttest\"><string name=\"references\" "
      "value=\"1.5,   2.000000000000000000000\"/>"
      "<float name=\"significanceLevel\" value=\"0.05\"/><integer name=\"sampleCount\" "
      "value=\"500\"/>\n" +
      scene_of_claims + "\n<scene><integrator type=\"av\"/>" + nori_camera + "</scene></test>");
  ASSERT_EQ(claims.size(), 2u);
  EXPECT_EQ(claims[0].kind, NoriTest::Kind::radiance);
  EXPECT_EQ(claims[0].name, "scene on line 2");
  EXPECT_EQ(claims[0].expected, 1.5);
  EXPECT_EQ(claims[1].expected, 2);
  EXPECT_EQ(claims[0].samples, 500);
  EXPECT_EQ(claims[0].level, sidak_level(0.05, 2));
  EXPECT_EQ(only(claims[0].description, "integrator").type, "path");
  // The mean of the picture is that of its pixels.
  EXPECT_EQ(only(only(only(claims[0].description, "sensor"), "film"), "rfilter").type, "box");
  EXPECT_EQ(claims[0].obstacle, "");
  EXPECT_NE(claims[1].obstacle, "");
}

TEST(NoriTests, BsdfsWithAngles) {
  const auto claims = read_claims(
      "<test type=\"ttest\"><string name=\"references\" value=\".2 .3\"/>"
      "<string name=\"angles\" value=\"0, 60\"/><bsdf type=\"microfacet\"/></test>");
  ASSERT_EQ(claims.size(), 2u);
  EXPECT_EQ(claims[1].kind, NoriTest::Kind::reflectance);
  EXPECT_EQ(claims[1].angle_degrees, 60);
  EXPECT_EQ(claims[1].expected, 0.3);
  EXPECT_EQ(claims[1].samples, 100'000);
  EXPECT_EQ(bsdf_of(claims[1].description)->type, "blendbsdf");
}

TEST(NoriTests, Densities) {
  const auto claims = read_claims(
      "<test type=\"chi2test\"><integer name=\"resolution\" value=\"8\"/>"
      "<integer name=\"testCount\" value=\"3\"/><integer name=\"minExpFrequency\" value=\"7\"/>"
      "<bsdf type=\"diffuse\"/><bsdf type=\"microfacet\"/></test>");
  ASSERT_EQ(claims.size(), 6u);
  EXPECT_EQ(claims[4].kind, NoriTest::Kind::density);
  EXPECT_EQ(claims[4].direction, 1);
  EXPECT_EQ(claims[4].rows, 8);
  EXPECT_EQ(claims[4].minimum_expected, 7);
  EXPECT_EQ(claims[4].samples, 5000 * 8 * 16);
  EXPECT_EQ(claims[4].level, sidak_level(0.01, 6));
}

TEST(NoriTests, AskForWhatCannotBe) {
  const auto problem = [](const std::string& text) {
    return problems_of([&] { read_claims(text); })[0].message;
  };
  EXPECT_NE(problem("<test type=\"ttest\">" + scene_of_claims + "</test>").find("0 references"),
            std::string::npos);
  EXPECT_NE(problem("<test type=\"ttest\"/>").find("0 scenes"), std::string::npos);
  EXPECT_NE(problem("<test type=\"warptest\"/>").find("no such test"), std::string::npos);
  EXPECT_NE(problem("<test type=\"chi2test\"/>").find("no bsdf"), std::string::npos);
  EXPECT_NE(problem(scene_of_claims).find("no tests"), std::string::npos);
  EXPECT_NE(problem("<test type=\"chi2test\"><integer name=\"testCount\" value=\"2000000000\"/>"
                    "<bsdf type=\"diffuse\"/></test>")
                .find("too much"),
            std::string::npos);
}

}  // namespace
}  // namespace kaustik::nori
