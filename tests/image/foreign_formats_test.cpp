// Formats that are read, but not written: pixels by hand.

#include "kaustik/image/image_io.h"
#include "tests/image/samples.h"
#include "tests/image/support.h"

namespace kaustik {
namespace {

class ForeignFormats : public testing::FileTest {
 protected:
  /// 8-bit values of the file's pixels, top down.
  std::vector<int> values_of(const std::string& name, const std::string& bytes) const {
    put(path(name), bytes);
    ReadOptions options;
    options.srgb_to_linear = false;
    const Image image = read_image(path(name), options);
    EXPECT_TRUE(image.is_srgb_encoded());
    std::vector<int> values;
    for (size_t i = 0; i < image.pixel_count(); ++i)
      for (int c = 0; c < image.channel_count(); ++c)
        values.push_back(int(std::lround(255 * image.channel(c)[i])));
    return values;
  }
};

TEST_F(ForeignFormats, bmp) {
  using testing::bmp;
  // Blue first, from below, lines padded to four bytes.
  EXPECT_EQ(values_of("a", bmp(1, 2, 24, 0, "", std::string("\1\2\3\0\4\5\6\0", 8))),
            (std::vector{6, 5, 4, 3, 2, 1}));
  EXPECT_EQ(values_of("a", bmp(1, -2, 24, 0, "", std::string("\1\2\3\0\4\5\6\0", 8))),
            (std::vector{3, 2, 1, 6, 5, 4}));
  const std::string palette("\1\2\3\0\4\5\6\0", 8);
  EXPECT_EQ(values_of("a", bmp(3, 1, 1, 0, palette, std::string("\240\0\0\0", 4))),
            (std::vector{6, 5, 4, 3, 2, 1, 6, 5, 4}));
  // Five bits each, 31 being all.
  EXPECT_EQ(values_of("a", bmp(1, 1, 16, 0, "", std::string("\37\174\0\0", 4))),
            (std::vector{255, 0, 255}));
  EXPECT_EQ(values_of("a", testing::bmp_with_masks()),
            (std::vector{7, 8, 9, 255, 10, 11, 12, 0, 1, 2, 3, 128, 4, 5, 6, 128}));
}

TEST_F(ForeignFormats, bmp_with_runs) {
  const std::vector<int> values = values_of("a", testing::bmp_with_runs());
  // Which of black 0, red 1, green 2 and blue 3 a pixel is.
  std::string colours;
  for (size_t i = 0; i < values.size(); i += 3)
    colours += values[i] ? '1' : values[i + 1] ? '2' : values[i + 2] ? '3' : '0';
  EXPECT_EQ(colours,
            "22220000"
            "00000000"
            "00123000"
            "11111111");
}

TEST_F(ForeignFormats, tga) {
  using testing::tga;
  const std::vector<int> runs = values_of("a.tga", testing::tga_with_runs());
  ASSERT_EQ(runs.size(), 36u);
  for (size_t i = 0; i < 18; ++i) EXPECT_EQ(runs[i], 3 - int(i % 3));
  for (size_t i = 0; i < 18; ++i) EXPECT_EQ(runs[18 + i], 10 * int(i / 3 * 3 + 2 - i % 3));
  // From below, from the left; then from above and the right.
  EXPECT_EQ(values_of("a.TGA", tga(3, 2, 2, 8, 0, "\1\2\3\4")), (std::vector{3, 4, 1, 2}));
  EXPECT_EQ(values_of("a.tga", tga(3, 2, 2, 8, 0x30, "\1\2\3\4")), (std::vector{2, 1, 4, 3}));
  EXPECT_EQ(values_of("a.tga", tga(2, 1, 1, 32, 8, "\1\2\3\4")), (std::vector{3, 2, 1, 4}));
  // Two colours of a map that begins at 5.
  const std::string map = std::string{0, 1, 1, 5, 0, 2, 0, 24} + std::string(4, '\0') +
                          testing::u16(2) + testing::u16(1) + std::string{8, 0} + "\1\2\3\4\5\6" +
                          "\6\5";
  EXPECT_EQ(values_of("a.tga", map), (std::vector{6, 5, 4, 3, 2, 1}));
  put(path("b.tga"), map.substr(0, map.size() - 1) + "\7");
  testing::expect_input_error([&] { read_image(path("b.tga")); }, "colour map");
}

TEST_F(ForeignFormats, webp) {
  const std::vector<int> values = values_of("a", testing::webp_picture(3, 2));
  EXPECT_EQ(values,
            (std::vector{0, 0, 200, 10, 0, 200, 20, 0, 200, 0, 10, 200, 10, 10, 200, 20, 10, 200}));
}

TEST_F(ForeignFormats, cmyk_jpeg) {
  for (const bool by_adobe : {false, true}) {
    const std::vector<int> values = values_of("a", testing::cmyk_jpeg(8, 8, by_adobe));
    ASSERT_EQ(values.size(), 192u);
    // What ink leaves: (1 − 0.2, 1, 1 − 0.6) · (1 − 0.5), to the rounding of JPEG.
    EXPECT_NEAR(values[0], 102, 2);
    EXPECT_NEAR(values[1], 127, 2);
    EXPECT_NEAR(values[2], 51, 2);
  }
}

}  // namespace
}  // namespace kaustik
