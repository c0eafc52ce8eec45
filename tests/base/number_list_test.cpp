#include "kaustik/base/number_list.h"

#include <gtest/gtest.h>

namespace kaustik {
namespace {

TEST(NumberList, TakesCommasSemicolonsAndBlanks) {
  const NumberList list = parse_number_list(" 1, 2.5;-3e2\n 4,,5 ");
  EXPECT_EQ(list.numbers, (std::vector<double>{1, 2.5, -300, 4, 5}));
  EXPECT_TRUE(list.wrong_word.empty());
  EXPECT_TRUE(parse_number_list("").numbers.empty());
}

TEST(NumberList, StopsAtWhatIsNoFiniteNumber) {
  for (const std::string wrong : {"x", "1x", "nan", "inf", "1e999", "--1", "0x10"}) {
    const NumberList list = parse_number_list("7 " + wrong + " 8");
    EXPECT_EQ(list.numbers, std::vector<double>{7}) << wrong;
    EXPECT_EQ(list.wrong_word, wrong);
  }
  EXPECT_EQ(parse_number_list(std::string(100, 'y')).wrong_word.size(), 60u);
}

}  // namespace
}  // namespace kaustik
