// Pictures from buffers: the same as those from files, and what is refused.

#include "kaustik/image/array_image.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <limits>
#include <random>

#include "kaustik/base/error.h"
#include "kaustik/base/file.h"

namespace kaustik {
namespace {

void expect_same(const Image& a, const Image& b) {
  ASSERT_EQ(a.width(), b.width());
  ASSERT_EQ(a.height(), b.height());
  ASSERT_EQ(a.channel_names(), b.channel_names());
  EXPECT_EQ(a.is_srgb_encoded(), b.is_srgb_encoded());
  for (int c = 0; c < a.channel_count(); ++c)
    for (size_t i = 0; i < a.pixel_count(); ++i)
      ASSERT_EQ(a.channel(c)[i], b.channel(c)[i]) << c << " " << i;
}

/// The picture of a Netpbm file of these samples.
Image from_file(const std::string& kind, size_t width, size_t height, int maximum,
                const std::vector<uint8_t>& samples, const ReadOptions& options) {
  const std::string path = testing::TempDir() + "kaustik_" + std::to_string(::getpid()) + ".pnm";
  const std::string head = kind + "\n" + std::to_string(width) + " " + std::to_string(height) +
                           "\n" + std::to_string(maximum) + "\n";
  std::vector<uint8_t> bytes(head.begin(), head.end());
  bytes.insert(bytes.end(), samples.begin(), samples.end());
  write_file_atomically(path, bytes);
  Image image = read_image(path, options);
  ::unlink(path.c_str());
  return image;
}

TEST(ArrayImage, IsThePictureThatAFileIs) {
  constexpr size_t width = 13, height = 7;
  std::mt19937 random(1);
  for (const size_t channels : {size_t(1), size_t(3)})
    for (const bool raw : {false, true}) {
      const size_t count = width * height * channels;
      std::vector<uint8_t> bytes, big_endian;
      std::vector<uint16_t> words;
      for (size_t i = 0; i < count; ++i) {
        bytes.push_back(uint8_t(random()));
        words.push_back(uint16_t(random()));
        big_endian.push_back(uint8_t(words.back() >> 8));
        big_endian.push_back(uint8_t(words.back()));
      }
      ReadOptions options;
      options.srgb_to_linear = !raw;
      const std::string kind = channels == 1 ? "P5" : "P6";
      const std::vector<size_t> extents = {height, width, channels};
      expect_same(image_of_array(*Array::of(extents, bytes), options),
                  from_file(kind, width, height, 255, bytes, options));
      expect_same(image_of_array(*Array::of(extents, words), options),
                  from_file(kind, width, height, 65535, big_endian, options));
    }
}

TEST(ArrayImage, FloatsAreLinearAndGreyNeedsNoThirdExtent) {
  const auto flat = Array::of<float>({2, 3}, {0, 0.5f, 1, 2, -1, 1e6f});
  const auto deep = Array::of<double>({2, 3, 1}, {0, 0.5, 1, 2, -1, 1e6});
  expect_same(image_of_array(*flat), image_of_array(*deep));
  EXPECT_EQ(image_of_array(*flat).at(1, 0, 0), 0.5f);
  const Image four = image_of_array(*Array::of<float>({1, 1, 4}, {0.1f, 0.2f, 0.3f, 0.4f}));
  EXPECT_EQ(four.channel_names(), (std::vector<std::string>{"R", "G", "B", "A"}));
  EXPECT_EQ(four.at(0, 0, 3), 0.4f);
}

std::string error_of(const Array& array, const ReadOptions& options = {}) {
  try {
    image_of_array(array, options);
  } catch (const Error& error) {
    EXPECT_FALSE(error.problems()[0].remedy.empty());
    return error.problems()[0].message;
  }
  return "";
}

TEST(ArrayImage, RefusesWhatIsNoPicture) {
  EXPECT_EQ(error_of(*Array::of<float>({4}, {1, 2, 3, 4})),
            "a picture cannot have the extents [4]");
  EXPECT_EQ(error_of(*Array::of<float>({1, 1, 2}, {1, 2})),
            "a picture cannot have the extents [1, 1, 2]");
  EXPECT_NE(error_of(*Array::of<float>({0, 5, 3}, {})), "");
  EXPECT_NE(error_of(*Array::of<float>({size_t(1) << 40, 0, 3}, {})), "");
  EXPECT_EQ(error_of(*Array::of<int32_t>({1, 1}, {1})), "a picture cannot be made of int32");
  ReadOptions narrow;
  narrow.memory_bytes = 1000;
  narrow.kept_bytes_per_pixel = 22;
  EXPECT_NE(error_of(*Array::of<uint8_t>({10, 10}, std::vector<uint8_t>(100)), narrow), "");
  narrow.memory_bytes = 2600;
  EXPECT_EQ(error_of(*Array::of<uint8_t>({10, 10}, std::vector<uint8_t>(100)), narrow), "");
}

}  // namespace
}  // namespace kaustik
