#include "kaustik/base/text_lines.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>

namespace kaustik::test {
namespace {

/// A text file that lives as long as this.
class TextFile {
 public:
  explicit TextFile(const std::string& text)
      : path_(testing::TempDir() + "kaustik_lines_" + std::to_string(::getpid())) {
    std::ofstream(path_, std::ios::binary) << text;
  }
  ~TextFile() { std::filesystem::remove(path_); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// The lines with their numbers, which count from `first` on; moves that behind them.
std::vector<std::string> numbered_lines(TextLines& lines, int& first) {
  std::vector<std::string> all;
  for (std::string_view line; lines.next(line);)
    all.push_back(std::to_string(first + lines.number() - 1) + ":" + std::string(line));
  first += lines.number() - 1;
  return all;
}

/// Wherever it is divided, the parts of a file have its lines, each once and with its number.
TEST(TextLines, PartsHaveTheLinesOfTheWhole) {
  std::mt19937 random(5);
  const std::string letters = "ab\\\\\r\n\n ";
  for (int round = 0; round < 300; ++round) {
    std::string text;
    const size_t size = 8 + random() % 120;
    for (size_t i = 0; i < size; ++i) text += letters[random() % letters.size()];
    const TextFile file(text);
    TextLines whole(file.path());
    int lines_of_whole = 1;
    const std::vector<std::string> expected = numbered_lines(whole, lines_of_whole);
    const InputFile input(file.path());
    std::vector<std::string> found;
    int lines_of_parts = 1;
    const uint64_t step = 4 + random() % 40;
    for (uint64_t begin = 0; begin < size; begin += step) {
      TextLines part(input, begin, std::min<uint64_t>(begin + step, size));
      for (std::string& line : numbered_lines(part, lines_of_parts))
        found.push_back(std::move(line));
    }
    ASSERT_EQ(found, expected) << testing::PrintToString(text) << ", by " << step;
    EXPECT_EQ(lines_of_parts, lines_of_whole);
  }
}

/// One line over all parts: only the first one reads it.
TEST(TextLines, LongLinesBelongToOnePart) {
  const size_t size = 3'000'000;
  const TextFile file(std::string(size, 'x') + "\nend");
  const InputFile input(file.path());
  int found = 0;
  for (uint64_t begin = 0; begin < size + 4; begin += 100'000) {
    TextLines part(input, begin, std::min<uint64_t>(begin + 100'000, size + 4));
    for (std::string_view line; part.next(line); ++found)
      EXPECT_EQ(line.size(), found == 0 ? size : 3);
  }
  EXPECT_EQ(found, 2);
}

}  // namespace
}  // namespace kaustik::test
