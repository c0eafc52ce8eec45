#pragma once
// What the tests of this room share.

#include <gtest/gtest.h>
#include <stdlib.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "kaustik/base/error.h"
#include "kaustik/image/image.h"

namespace kaustik::testing {

/// A folder of its own for each test, removed at its end.
class FileTest : public ::testing::Test {
 protected:
  FileTest() {
    std::string pattern = (std::filesystem::temp_directory_path() / "kaustik_XXXXXX").string();
    if (!::mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder");
    folder_ = pattern;
  }
  ~FileTest() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  size_t file_count() const {
    return size_t(std::distance(std::filesystem::directory_iterator(folder_),
                                std::filesystem::directory_iterator()));
  }
  static std::string contents(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  static void put(const std::string& file, const std::string& bytes) {
    // Some file systems wait for the disk when a file is truncated, but not for a new one.
    std::filesystem::remove(file);
    std::ofstream(file, std::ios::binary) << bytes;
  }

  std::filesystem::path folder_;
};

/// The kind and the text of the kaustik::Error that `action` throws; fails if it throws none.
struct Caught {
  bool is_error = false;
  ErrorKind kind = ErrorKind::system;
  std::string text, remedy;
};
inline Caught caught(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return {true, error.kind(), error.what(), error.problems().front().remedy};
  }
  return {};
}
/// Expects an input error that names `part` and a remedy.
inline void expect_input_error(const std::function<void()>& action, const std::string& part) {
  const Caught error = caught(action);
  ASSERT_TRUE(error.is_error) << "no error; expected one about " << part;
  EXPECT_EQ(error.kind, ErrorKind::input) << error.text;
  EXPECT_NE(error.text.find(part), std::string::npos) << error.text;
  EXPECT_FALSE(error.remedy.empty()) << error.text;
}

/// Smooth colours over `decades` orders of magnitude with an area of equal pixels, so that run
/// length encoders meet both.
inline Image test_picture(int width, int height, double decades, uint32_t seed = 1) {
  Image image(width, height, {"R", "G", "B"});
  std::mt19937 generator(seed);
  std::uniform_real_distribution<float> uniform(0.2f, 1.0f);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) {
        const double exponent = decades * (double(x) / width - 0.5);
        const float level = float(std::pow(10.0, exponent));
        image.at(x, y, c) = y < height / 3 ? 0.25f : level * uniform(generator);
      }
  return image;
}

}  // namespace kaustik::testing
