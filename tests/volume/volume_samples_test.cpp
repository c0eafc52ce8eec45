// Files of volumes and buffers, good and hostile.

#include "kaustik/volume/volume_samples.h"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "kaustik/base/error.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/vol_file.h"

namespace kaustik::test {
namespace {

class VolFiles : public testing::Test {
 protected:
  std::string written(const std::string& bytes) {
    const std::string path = folder_.path("test.vol");
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }
  VolumeSamples read(const std::string& bytes) { return read_vol(written(bytes)); }
  /// The message of the error that the file makes; it has a remedy, and the file as its place.
  std::string problem_of(const std::string& bytes) {
    const std::string path = written(bytes);
    try {
      read_vol(path);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      const Problem& problem = error.problems().front();
      EXPECT_FALSE(problem.remedy.empty()) << problem.message;
      EXPECT_TRUE(problem.place.file && *problem.place.file == path);
      return problem.message;
    }
    return "";
  }
  void expect_problem(const std::string& bytes, const std::string& message) {
    const std::string found = problem_of(bytes);
    EXPECT_NE(found.find(message), std::string::npos) << "'" << found << "' instead of " << message;
  }

 private:
  TemporaryFolder folder_;
};

const std::vector<float> twelve = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};

std::string with_number(std::string bytes, size_t at, int32_t number) {
  std::memcpy(bytes.data() + at, &number, sizeof(number));
  return bytes;
}

TEST_F(VolFiles, OfFloats) {
  const VolumeSamples samples = read(vol_file({2, 3, 2}, twelve, {.box = {-1, -2, -3, 1, 2, 3}}));
  EXPECT_EQ(samples.size, (std::array<int, 3>{2, 3, 2}));
  EXPECT_EQ(samples.channels, 1);
  EXPECT_EQ(samples.values, twelve);
  ASSERT_TRUE(samples.box);
  EXPECT_EQ(samples.box->min, Vec3f(-1, -2, -3));
  EXPECT_EQ(samples.box->max, Vec3f(1, 2, 3));
}

TEST_F(VolFiles, OfBytesAndChannels) {
  const VolumeSamples bytes = read(vol_file({2, 1, 1}, {0, 1}, {.encoding = 3}));
  EXPECT_EQ(bytes.values, (std::vector<float>{0, 1}));
  for (const int channels : {3, 6})
    EXPECT_EQ(read(vol_file({12 / channels, 1, 1}, twelve, {.channels = channels})).channels,
              channels);
}

TEST_F(VolFiles, OfOtherKinds) {
  expect_problem("", "not a volume");
  expect_problem("VO", "not a volume");
  expect_problem("PNG and so on, for more than a header of 48 bytes takes", "not a volume");
  expect_problem(std::string("NanoVDB0") + std::string(64, 'x'), "not read yet");
  expect_problem(std::string(" BDV") + std::string(64, '\0'), "not read yet");
  std::string version = vol_file({2, 3, 2}, twelve);
  version[3] = 2;
  expect_problem(version, "version 2");
}

TEST_F(VolFiles, Truncated) {
  const std::string whole = vol_file({2, 3, 2}, twelve);
  for (size_t size = 0; size < whole.size(); ++size)
    EXPECT_NE(problem_of(whole.substr(0, size)), "") << size;
  expect_problem(whole + "x", "but 49 are there");
  EXPECT_EQ(problem_of(whole), "");
}

TEST_F(VolFiles, OfHostileSizes) {
  const std::string good = vol_file({2, 3, 2}, twelve);
  expect_problem(with_number(good, 4, 2), "encoding 2");
  for (const size_t at : {8, 12, 16})
    for (const int32_t count : {0, -1, std::numeric_limits<int32_t>::min()})
      expect_problem(with_number(good, at, count), "cells along");
  for (const int32_t channels : {0, 2, -3, 7, std::numeric_limits<int32_t>::max()})
    expect_problem(with_number(good, 20, channels), "channels");
  // 2^31 − 1 cells along each axis, 2^31 in all, and as many as memory holds but the file does not.
  constexpr int32_t most = std::numeric_limits<int32_t>::max();
  expect_problem(with_number(with_number(with_number(good, 8, most), 12, most), 16, most), "cells");
  expect_problem(with_number(with_number(with_number(good, 8, 1 << 11), 12, 1 << 10), 16, 1 << 10),
                 "cells");
  expect_problem(with_number(with_number(with_number(good, 8, 1000), 12, 1000), 16, 1000),
                 "4000000000 bytes");
  // 2^31 cells in a row of rows, as bytes, too.
  for (const int32_t encoding : {1, 3})
    expect_problem(with_number(with_number(with_number(good, 4, encoding), 8, 1 << 30), 12, 2),
                   "cells");
}

TEST_F(VolFiles, OfNumbersThatAreNone) {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1e31f}) {
    std::vector<float> values = twelve;
    values[7] = bad;
    expect_problem(vol_file({2, 3, 2}, values), "cell (1, 0, 1)");
  }
}

TEST_F(VolFiles, WithFlippedBytesAreReadOrRefused) {
  const std::string good = vol_file({2, 3, 2}, twelve);
  for (size_t at = 0; at < good.size(); ++at)
    for (const int flip : {0x01, 0x80}) {
      std::string bytes = good;
      bytes[at] = char(bytes[at] ^ flip);
      const std::string problem = problem_of(bytes);
      if (problem.empty()) {
        EXPECT_EQ(read(bytes).values.size(), 12u);
      }
    }
}

TEST(VolumeBuffers, AreReadByTheirType) {
  const auto array = Array::of<uint8_t>({1, 2, 3}, {0, 51, 102, 153, 204, 255});
  const VolumeSamples bytes = samples_of_array(*array);
  EXPECT_EQ(bytes.size, (std::array<int, 3>{3, 2, 1}));
  EXPECT_FALSE(bytes.box);
  for (size_t i = 0; i < 6; ++i) EXPECT_FLOAT_EQ(bytes.values[i], 0.2f * float(i));
  EXPECT_EQ(samples_of_array(*Array::of<double>({1, 1, 2, 3}, {0, 1, 2, 3, 4, 5})).channels, 3);
}

TEST(VolumeBuffers, ThatMakeNone) {
  const auto problem_of = [](const std::shared_ptr<const Array>& array) -> std::string {
    try {
      samples_of_array(*array);
    } catch (const Error& error) {
      EXPECT_FALSE(error.problems().front().remedy.empty());
      return error.problems().front().message;
    }
    return "";
  };
  EXPECT_NE(problem_of(Array::of<float>({2, 2}, {0, 1, 2, 3})).find("extents"), std::string::npos);
  EXPECT_NE(problem_of(Array::of<float>({1, 1, 1, 2}, {0, 1})).find("channels"), std::string::npos);
  EXPECT_NE(problem_of(Array::of<float>({0, 1, 1}, {})).find("cells"), std::string::npos);
  EXPECT_NE(problem_of(Array::of<int32_t>({1, 1, 1}, {0})).find("int32"), std::string::npos);
  EXPECT_NE(problem_of(Array::of<float>({1, 1, 1}, {std::nanf("")})).find("cell (0, 0, 0)"),
            std::string::npos);
}

}  // namespace
}  // namespace kaustik::test
