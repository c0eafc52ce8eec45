// Text files of places and directions.

#include "kaustik/scene/direction_file.h"

#include <gtest/gtest.h>

#include <fstream>

#include "kaustik/base/error.h"
#include "tests/support/temporary_folder.h"

namespace kaustik {
namespace {

class DirectionFiles : public testing::Test {
 protected:
  std::vector<DirectedPlace> read(const std::string& text, size_t most = 100) {
    std::ofstream(folder_.path("points.txt"), std::ios::binary) << text;
    return read_direction_file(folder_.path("points.txt"), most);
  }
  /// "line: message" of what is wrong.
  std::string failure_of(const std::string& text, size_t most = 100) {
    try {
      read(text, most);
    } catch (const Error& error) {
      const Problem& problem = error.problems().front();
      EXPECT_NE(problem.remedy.find("six numbers"), std::string::npos);
      return std::to_string(problem.place.line) + ": " + problem.message;
    }
    return "read";
  }
  test::TemporaryFolder folder_;
};

TEST_F(DirectionFiles, HaveSixNumbersOnALine) {
  const auto rows = read("# desk\n1 2 .75  0 0 1\n\n-3,+4;1e1\t0,-1,0 # wall\r\n");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].place, Vec3d(1, 2, 0.75));
  EXPECT_EQ(rows[0].direction, Vec3d(0, 0, 1));
  EXPECT_EQ(rows[1].place, Vec3d(-3, 4, 10));
  EXPECT_EQ(rows[1].direction, Vec3d(0, -1, 0));
}

TEST_F(DirectionFiles, MayHaveATitle) {
  EXPECT_EQ(read("x,y,z,nx,ny,nz\n0,0,0,0,0,1\n").size(), 1u);
}

TEST_F(DirectionFiles, AreRefusedWithTheirLine) {
  EXPECT_EQ(failure_of("0 0 0 0 0 1\n1 2 3\n"), "2: there are 3 numbers");
  EXPECT_EQ(failure_of("0 0 0 0 0 1\n0 0 0 0 up 1\n"), "2: 'up' is not a number");
  EXPECT_EQ(failure_of("0 0 0 0 0 1\nx y z a b c\n"), "2: 'x' is not a number");
  EXPECT_EQ(failure_of("O.5 0 0 0 0 1\n"), "1: 'O.5' is not a number");
  EXPECT_EQ(failure_of("\n0 0 0 0 0 0\n"), "2: the direction is zero");
  EXPECT_EQ(failure_of("0 0 nan 0 0 1\n"), "1: 'nan' is not a number");
  EXPECT_EQ(failure_of("# nothing\n"), "0: there is no row of numbers");
  EXPECT_EQ(failure_of("0 0 0 0 0 1\n0 0 0 0 0 1\n", 1), "2: there are more than 1 rows");
}

}  // namespace
}  // namespace kaustik
