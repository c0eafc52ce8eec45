// EXR data and display windows, and other primaries.

#include <OpenEXR/ImfRgbaFile.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include "kaustik/image/image_io.h"
#include "kaustik/image/metrics.h"
#include "kaustik/image/primaries.h"
#include "tests/image/samples.h"
#include "tests/image/support.h"

namespace kaustik {
namespace {

using Window = testing::FileTest;

/// A file with these windows whose pixel (x, y) is (x, y, 1).
void write_windows(const std::string& path, const Imath::Box2i& display, const Imath::Box2i& data) {
  const int width = data.max.x - data.min.x + 1, height = data.max.y - data.min.y + 1;
  std::vector<Imf::Rgba> pixels;
  for (int y = data.min.y; y <= data.max.y; ++y)
    for (int x = data.min.x; x <= data.max.x; ++x) pixels.emplace_back(float(x), float(y), 1.0f);
  Imf::RgbaOutputFile file(path.c_str(), display, data, Imf::WRITE_RGB);
  file.setFrameBuffer(Imf::ComputeBasePointer(pixels.data(), data), 1, size_t(width));
  file.writePixels(height);
}

TEST_F(Window, pixels_keep_their_place_in_the_picture) {
  write_windows(path("a.exr"), {{10, 20}, {17, 25}}, {{12, 21}, {14, 22}});
  const Image part = read_image(path("a.exr"));
  EXPECT_EQ(part.width(), 3);
  EXPECT_EQ(part.frame(), (PictureFrame{8, 6, 2, 1}));
  ReadOptions options;
  options.whole_picture = true;
  const Image whole = read_image(path("a.exr"), options);
  ASSERT_EQ(whole.width(), 8);
  ASSERT_EQ(whole.height(), 6);
  EXPECT_TRUE(whole.is_whole());
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 8; ++x) {
      const bool is_there = x >= 2 && x <= 4 && y >= 1 && y <= 2;
      EXPECT_EQ(whole.at(x, y, whole.find_channel("R")), is_there ? float(x + 10) : 0.0f);
      EXPECT_EQ(whole.at(x, y, whole.find_channel("G")), is_there ? float(y + 20) : 0.0f);
    }
  EXPECT_EQ(compare_images(whole_picture(part), whole).mse, 0);
}

TEST_F(Window, what_lies_beyond_the_picture_is_left_out) {
  write_windows(path("a.exr"), {{0, 0}, {3, 2}}, {{-5, -1}, {6, 9}});
  ReadOptions options;
  options.whole_picture = true;
  const Image whole = read_image(path("a.exr"), options);
  ASSERT_EQ(whole.width(), 4);
  ASSERT_EQ(whole.height(), 3);
  for (int x = 0; x < 4; ++x) EXPECT_EQ(whole.at(x, 2, whole.find_channel("R")), float(x));
  EXPECT_EQ(compare_images(visible_part(read_image(path("a.exr"))), whole).mse, 0);
}

TEST_F(Window, survives_writing_and_reading) {
  Image image = testing::test_picture(5, 4, 1);
  image.set_frame({20, 10, 7, 3});
  write_image(image, path("a.exr"));
  EXPECT_EQ(read_image(path("a.exr")).frame(), image.frame());
}

TEST_F(Window, a_crop_is_compared_at_its_place) {
  const Image whole = testing::test_picture(20, 10, 2);
  Image crop = window_of(whole, 7, 3, 5, 4);
  const auto error = [](const Image& a, const Image& b) {
    const SamePixels same = same_pixels(a, b);
    return compare_images(same.image, same.reference).mse;
  };
  EXPECT_EQ(error(crop, crop), 0);
  EXPECT_EQ(error(crop, whole), 0);
  EXPECT_EQ(error(whole, crop), 0);
  Image without_frame = crop;
  without_frame.set_frame({5, 4});
  EXPECT_EQ(error(crop, without_frame), 0);
  crop.set_frame({20, 10, 8, 3});  // at a wrong place
  EXPECT_GT(error(crop, whole), 0);
  testing::expect_input_error([&] { same_pixels(without_frame, whole); }, "5 x 4 pixels");
  testing::expect_input_error([&] { same_pixels(crop, window_of(whole, 0, 0, 5, 4)); },
                              "5 x 4 pixels at (8, 3) of 20 x 10");
}

TEST_F(Window, what_shows_nothing_of_its_picture_is_not_compared) {
  const Image whole = testing::test_picture(20, 10, 2);
  for (const PictureFrame& beyond : {PictureFrame{20, 10, 20, 0}, PictureFrame{20, 10, 0, 10},
                                     PictureFrame{20, 10, -5, 3}, PictureFrame{20, 10, 3, -4}}) {
    Image none = window_of(whole, 0, 0, 5, 4);
    none.set_frame(beyond);
    EXPECT_FALSE(has_visible_part(none));
    testing::expect_input_error([&] { same_pixels(none, whole); }, "lies in the picture");
    testing::expect_input_error([&] { same_pixels(whole, none); }, "lies in the picture");
    testing::expect_input_error([&] { visible_part(none); }, "none of the 5 x 4 pixels");
  }
  Image corner = window_of(whole, 0, 0, 5, 4);
  corner.set_frame({20, 10, 19, 9});
  EXPECT_TRUE(has_visible_part(corner));
  EXPECT_EQ(visible_part(corner).pixel_count(), 1u);
}

TEST(Primaries, white_stays_white_and_rec_709_stays_itself) {
  EXPECT_FALSE(rec709_from(rec709_primaries()));
  // ACES AP0, whose blue lies below the axis, with its own white.
  const Primaries aces{{0.7347f, 0.2653f}, {0, 1}, {0.0001f, -0.077f}, {0.32168f, 0.33767f}};
  const Vec3f white = rec709_from(aces).value() * Vec3f(1, 1, 1);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(white[c], 1, 1e-5);
  // Red and green exchanged exchange them.
  Primaries swapped = rec709_primaries();
  std::swap(swapped.red, swapped.green);
  const Vec3f colour = rec709_from(swapped).value() * Vec3f(0.1f, 0.2f, 0.3f);
  EXPECT_NEAR(colour.x, 0.2f, 1e-6);
  EXPECT_NEAR(colour.y, 0.1f, 1e-6);
  EXPECT_NEAR(colour.z, 0.3f, 1e-6);
  EXPECT_THROW(rec709_from({{0.3f, 0.3f}, {0.3f, 0.3f}, {0.3f, 0.3f}, {0.3f, 0.3f}}), Error);
}

TEST_F(Window, primaries_of_files_are_converted) {
  {
    Imf::Header header(1, 1);
    Imf::Chromaticities swapped;
    std::swap(swapped.red, swapped.green);
    Imf::addChromaticities(header, swapped);
    Imf::RgbaOutputFile file(path("a.exr").c_str(), header, Imf::WRITE_RGB);
    const Imf::Rgba pixel(0.25f, 0.5f, 1.0f);
    file.setFrameBuffer(&pixel, 1, 1);
    file.writePixels(1);
  }
  const Image exr = read_image(path("a.exr"));
  EXPECT_NEAR(exr.at(0, 0, exr.find_channel("R")), 0.5f, 1e-5);
  EXPECT_NEAR(exr.at(0, 0, exr.find_channel("G")), 0.25f, 1e-5);
  const std::string pixels("\100\200\300\201", 4);  // (64.5, 128.5, 192.5)/128
  put(path("a.hdr"),
      "#?RADIANCE\nPRIMARIES= .3 .6 .64 .33 .15 .06 .3127 .329\nCOLORCORR=2 4 0.5\n"
      "COLORCORR= 1 .5 1\nEXPOSURE=2\n\n-Y 1 +X 1\n" +
          pixels);
  const Image image = read_image(path("a.hdr"));
  EXPECT_NEAR(image.at(0, 0, 0), 128.5f / 128 / 2 / 2, 1e-5);
  EXPECT_NEAR(image.at(0, 0, 1), 64.5f / 128 / 2 / 2, 1e-5);
  EXPECT_NEAR(image.at(0, 0, 2), 192.5f / 128 / 2 / 0.5f, 1e-5);
}

TEST_F(Window, luminance_with_chroma) {
  testing::luminance_chroma_exr(path("a.exr"), 16, 8);
  const Image image = read_image(path("a.exr"));
  const RgbView rgb = rgb_view(image);
  for (size_t x = 0; x < 16; ++x)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(rgb[x][c], float(x) / 16, 0.01f);
}

}  // namespace
}  // namespace kaustik
