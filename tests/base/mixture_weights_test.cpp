#include "kaustik/base/mixture_weights.h"

#include <gtest/gtest.h>

namespace kaustik {
namespace {

std::string problem_of(const Value& weights) {
  return mixture_weights(weights, 2, "phase functions").problem;
}

TEST(MixtureWeights, AreNumbersForAllParts) {
  EXPECT_EQ(mixture_weights(std::string("0.5, 3"), 2, "parts").numbers,
            (std::vector<double>{0.5, 3}));
  EXPECT_EQ(mixture_weights(2.5, 1, "parts").numbers, std::vector<double>{2.5});
  EXPECT_EQ(mixture_weights(int64_t{2}, 1, "parts").numbers, std::vector<double>{2});
}

TEST(MixtureWeights, TellWhatIsWrong) {
  EXPECT_EQ(problem_of(std::string("0, 1")), "");
  EXPECT_EQ(problem_of(std::string("1 -1")), "'weights' holds -1, which is below 0");
  EXPECT_EQ(problem_of(std::string("1,inf")), "'weights' holds 'inf', which is no number");
  EXPECT_EQ(problem_of(std::string("1e308 1e308")),
            "'weights' holds 1e+308, which is above a million");
  EXPECT_EQ(problem_of(std::string("0 0")), "'weights' are all 0");
  EXPECT_EQ(problem_of(std::string("1")), "'weights' has 1 number, for 2 phase functions");
  EXPECT_EQ(problem_of(1.0), "'weights' has 1 number, for 2 phase functions");
  EXPECT_TRUE(mixture_weights(std::string("1 -1"), 2, "parts").numbers.empty());
}

}  // namespace
}  // namespace kaustik
