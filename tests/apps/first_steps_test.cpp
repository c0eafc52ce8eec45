// What the program says to who gives it no command.

#include <algorithm>
#include <sstream>

#include "tests/apps/program.h"

namespace kaustik::test {
namespace {

class FirstSteps : public ProgramTest {};

size_t width_of(const std::string& line) {
  return size_t(
      std::count_if(line.begin(), line.end(), [](char c) { return (c & '\xc0') != '\x80'; }));
}

TEST_F(FirstSteps, AreToldWithoutACommand) {
  const RunResult result = run({});
  // Nothing was done.
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.out, "");
  std::istringstream text(result.err);
  int lines = 0;
  for (std::string line; std::getline(text, line); ++lines) EXPECT_LE(width_of(line), 80u) << line;
  EXPECT_LE(lines, 30);
  for (const char* part :
       {"Kaustik ", "\n  kaustik example caustic ",
        "\n  kaustik render caustic.xml --time 20s -o caustic.png ",
        "\n  kaustik view caustic.xml ", " render      Render a scene to image files\n",
        " tonemap     Convert high dynamic range images for displays\n",
        "\nThe manual: man kaustik", "kaustik help"})
    EXPECT_TRUE(contains(result.err, part)) << part << " is missing in\n" << result.err;
  EXPECT_TRUE(files().empty());
}

}  // namespace
}  // namespace kaustik::test
