#include "kaustik/base/to_integer.h"

#include <gtest/gtest.h>

#include <limits>

namespace kaustik {
namespace {

template <typename Float>
void expect_integers() {
  constexpr Float infinite = std::numeric_limits<Float>::infinity();
  constexpr Float no_number = std::numeric_limits<Float>::quiet_NaN();
  constexpr Float largest = std::numeric_limits<Float>::max();
  EXPECT_EQ(to_integer(Float(2.9), 0, 10), 2);
  EXPECT_EQ(to_integer(Float(-2.9), -10, 10), -2);
  EXPECT_EQ(to_integer(Float(-0.5), 0, 10), 0);
  EXPECT_EQ(to_integer(Float(10.5), 0, 10), 10);
  for (const Float high : {infinite, largest}) {
    EXPECT_EQ(to_integer(high, 0, 10), 10);
    EXPECT_EQ(to_integer(-high, 3, 10), 3);
  }
  EXPECT_EQ(to_integer(no_number, 3, 10), 3);
  EXPECT_EQ(to_integer(-no_number, -3, 10), -3);
  // The ends of the types, which floats cannot hold.
  constexpr int most = std::numeric_limits<int>::max(), least = std::numeric_limits<int>::min();
  EXPECT_EQ(to_integer(infinite, least, most), most);
  EXPECT_EQ(to_integer(Float(0x1p31), least, most), most);
  EXPECT_EQ(to_integer(Float(0x1.fffffcp30), least, most), 0x7fffff00);
  EXPECT_EQ(to_integer(-infinite, least, most), least);
  constexpr uint64_t most_of_all = std::numeric_limits<uint64_t>::max();
  EXPECT_EQ(to_integer(Float(0x1p64), uint64_t(0), most_of_all), most_of_all);
  EXPECT_EQ(to_integer<uint8_t>(Float(255.9), 0, 255), 255);
}

TEST(ToInteger, KeepsWithinItsRangeWhateverTheNumber) {
  expect_integers<float>();
  expect_integers<double>();
}

TEST(ToInteger, LatticeCellsHaveNeighbours) {
  EXPECT_EQ(lattice_cell(1.5f), 1);
  EXPECT_EQ(lattice_cell(-1.5f), -2);
  for (const float far : {1e10f, std::numeric_limits<float>::infinity(), 3e38f}) {
    EXPECT_EQ(lattice_cell(far), 1 << 30);
    EXPECT_EQ(lattice_cell(-far), -(1 << 30));
  }
  EXPECT_EQ(lattice_cell(std::numeric_limits<float>::quiet_NaN()), -(1 << 30));
}

}  // namespace
}  // namespace kaustik
