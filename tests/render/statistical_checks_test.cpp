// Claims of known truth, and planted errors that the same effort finds.

#include "kaustik/render/statistical_checks.h"

#include <gtest/gtest.h>

#include "kaustik/base/error.h"
#include "tests/support/measure.h"

namespace kaustik {
namespace {

using test::description_of;

Description ball(const std::string& bsdf) {
  return description_of("<shape type=\"sphere\">" + bsdf +
                        "</shape><sensor type=\"perspective\"/>");
}

const std::string grey = "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.4\"/></bsdf>";
const std::string metal =
    "<bsdf type=\"roughconductor\"><float name=\"alpha\" value=\"0.3\"/></bsdf>";
const std::string mirror = "<bsdf type=\"conductor\"/>";

TEST(StatisticalChecks, PicturesInAFurnace) {
  // From inside a ball that shines 1 and reflects ρ: 1 + ρ + ρ² + … = 1/(1 − ρ).
  const Description furnace = description_of(
      "<integrator type=\"path\"/><sensor type=\"perspective\"><film type=\"hdrfilm\">"
      "<integer name=\"width\" value=\"2\"/><integer name=\"height\" value=\"1\"/>"
      "<rfilter type=\"box\"/></film></sensor><shape type=\"sphere\">"
      "<boolean name=\"flip_normals\" value=\"true\"/>" +
      grey + "<emitter type=\"area\"><rgb name=\"radiance\" value=\"1\"/></emitter></shape>");
  const RunningStatistics values = picture_luminances(furnace, {20'000});
  EXPECT_EQ(values.count(), int64_t{replicate_count});
  EXPECT_GT(t_test_p_value(values, 1 / 0.6), 1e-4) << values.mean();
  EXPECT_LT(t_test_p_value(values, 1.01 / 0.6), 1e-4);
}

TEST(StatisticalChecks, ReflectanceIsThatOfEvenLight) {
  const RunningStatistics values = reflected_luminances(ball(grey), 60, {1000});
  EXPECT_EQ(values.count(), 1000);
  EXPECT_NEAR(values.mean(), 0.4, 1e-6);
  EXPECT_NEAR(reflected_luminances(ball(mirror), 30, {1000}).mean(), 1, 1e-6);
}

TEST(StatisticalChecks, SamplesFollowTheirDensity) {
  for (const std::string& bsdf : {grey, metal})
    for (const int direction : {0, 1})
      EXPECT_GT(sampling_p_value(ball(bsdf), direction, {}, {100'000}), 1e-4) << bsdf;
  try {
    sampling_p_value(ball(mirror), 0, {}, {1000});
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(error.problems()[0].message.find("no density"), std::string::npos);
  }
}

}  // namespace
}  // namespace kaustik
