#include <tiffio.h>

#include <algorithm>
#include <limits>

#include "kaustik/image/image_io.h"
#include "kaustik/image/photometry.h"
#include "tests/image/samples.h"
#include "tests/image/support.h"

namespace kaustik {
namespace {

using testing::expect_input_error;
using testing::test_picture;

class RoundTrip : public testing::FileTest {
 protected:
  Image written_and_read(const Image& image, const std::string& name,
                         const WriteOptions& options = {}) const {
    write_image(image, path(name), options);
    return read_image(path(name));
  }
};

/// Largest |a − b| over max(|a|, floor) of all pixels.
double largest_relative_error(const Image& a, const Image& b, float floor = 0) {
  const RgbView x = rgb_view(a), y = rgb_view(b);
  double largest = 0;
  for (size_t i = 0; i < a.pixel_count(); ++i)
    for (int c = 0; c < 3; ++c) {
      const double error = std::fabs(double(x[i][c]) - double(y[i][c]));
      largest = std::max(largest, error / double(std::max(std::fabs(x[i][c]), floor)));
    }
  return largest;
}

TEST_F(RoundTrip, exr_keeps_all_channels_in_float) {
  Image image(7, 5, {"R", "G", "B", "direct.R", "N.X", "depth.Z"});
  for (int c = 0; c < image.channel_count(); ++c)
    for (size_t i = 0; i < image.pixel_count(); ++i)
      image.channel(c)[i] = 1e5f * float(c) + float(i) / 3;
  image.at(0, 0, 0) = std::numeric_limits<float>::infinity();
  WriteOptions options;
  options.exr_half = false;
  const Image back = written_and_read(image, "a.exr", options);
  ASSERT_EQ(back.channel_count(), image.channel_count());
  for (int c = 0; c < image.channel_count(); ++c) {
    const int found = back.find_channel(image.channel_names()[size_t(c)]);
    ASSERT_GE(found, 0);
    for (size_t i = 0; i < image.pixel_count(); ++i)
      EXPECT_EQ(back.channel(found)[i], image.channel(c)[i]);
  }
}

TEST_F(RoundTrip, exr_half_has_eleven_bits_and_does_not_overflow) {
  Image image = test_picture(50, 20, 6);
  const int depth = image.add_channel("depth.Z");
  image.channel(depth)[3] = 123456.7f;
  const Image back = written_and_read(image, "a.exr");
  EXPECT_LE(largest_relative_error(image, back, 6.2e-5f), 0x1p-11);
  EXPECT_GT(largest_relative_error(image, back), 0);  // it is half indeed
  EXPECT_EQ(back.channel(back.find_channel("depth.Z"))[3], 123456.7f);
}

TEST_F(RoundTrip, exr_metadata) {
  Image image(2, 2, {"Y"});
  image.set_metadata("scene", std::string("scenes/cornell box.xml"));
  image.set_metadata("seconds", 1.0 / 3);
  image.set_metadata("passes", int64_t{64});
  image.set_metadata("seed", int64_t{1} << 62);
  image.set_metadata("a name of more than thirty-one characters", int64_t{-1});
  const Image back = written_and_read(image, "a.exr");
  EXPECT_EQ(std::get<std::string>(*back.find_metadata("scene")), "scenes/cornell box.xml");
  EXPECT_EQ(std::get<double>(*back.find_metadata("seconds")), 1.0 / 3);
  EXPECT_EQ(std::get<int64_t>(*back.find_metadata("passes")), 64);
  EXPECT_EQ(std::get<std::string>(*back.find_metadata("seed")), "4611686018427387904");
  EXPECT_EQ(std::get<int64_t>(*back.find_metadata("a name of more than thirty-one characters")),
            -1);
  EXPECT_EQ(back.metadata().size(), 5u);
  image.set_metadata("compression", 1.0);
  expect_input_error([&] { write_image(image, path("b.exr")); }, "'compression'");
}

TEST_F(RoundTrip, same_image_gives_the_same_bytes) {
  const Image image = test_picture(33, 17, 3);
  for (const std::string extension : {"exr", "hdr", "pfm", "tif", "png", "jpg", "ppm"}) {
    write_image(image, path("a." + extension));
    write_image(image, path("b." + extension));
    EXPECT_EQ(contents(path("a." + extension)), contents(path("b." + extension))) << extension;
  }
}

TEST_F(RoundTrip, pfm_is_exact) {
  Image image = test_picture(9, 4, 8);
  image.at(1, 1, 2) = -3;
  EXPECT_EQ(largest_relative_error(image, written_and_read(image, "a.pfm")), 0);
}

TEST_F(RoundTrip, hdr_has_eight_bits_of_the_largest_channel) {
  for (const int width : {1, 7, 8, 200, 1000}) {
    const Image image = test_picture(width, 6, 8);
    const Image back = written_and_read(image, "a.hdr");
    const RgbView x = rgb_view(image), y = rgb_view(back);
    double mean_error = 0;
    for (size_t i = 0; i < image.pixel_count(); ++i) {
      const float largest = std::max({x[i].x, x[i].y, x[i].z});
      for (int c = 0; c < 3; ++c) {
        ASSERT_LE(std::fabs(x[i][c] - y[i][c]), largest / 255) << width;
        // Not over the area of equal pixels, whose errors are equal too.
        if (i >= image.pixel_count() / 3)
          mean_error += double((y[i][c] - x[i][c]) / largest) / double(2 * image.pixel_count());
      }
    }
    // Not biased by truncation.
    if (width >= 200) {
      EXPECT_LT(std::fabs(mean_error), 3e-4);
    }
  }
}

TEST_F(RoundTrip, hdr_extremes) {
  Image image(9, 1, {"R", "G", "B"});
  image.at(0, 0, 0) = 1e38f;
  image.at(1, 0, 1) = 1e-30f;
  image.at(2, 0, 0) = -1;
  image.at(3, 0, 0) = std::numeric_limits<float>::quiet_NaN();
  const Image back = written_and_read(image, "a.hdr");
  EXPECT_NEAR(back.at(0, 0, 0) / 1e38f, 1, 0.01);
  EXPECT_NEAR(back.at(1, 0, 1) / 1e-30f, 1, 0.01);
  EXPECT_EQ(back.at(2, 0, 0), 0);
  EXPECT_EQ(back.at(3, 0, 0), 0);
}

TEST_F(RoundTrip, hdr_headers_of_other_programs) {
  // Two pixels, exposed, bottom up and right to left, then one line of old runs.
  const std::string pixels = {char(128), 64,       32,       char(129),
                              char(64),  char(64), char(64), char(128)};
  put(path("a.hdr"),
      "#?RGBE\n# comment\nEXPOSURE= 2.0\nFORMAT=32-bit_rle_rgbe\n\n+Y 1 -X 2\n" + pixels);
  const Image mirrored = read_image(path("a.hdr"));
  EXPECT_NEAR(mirrored.at(1, 0, 0), 128.5 / 128 / 2, 1e-6);
  EXPECT_NEAR(mirrored.at(0, 0, 0), 64.5 / 256 / 2, 1e-6);
  put(path("b.hdr"), "#?RADIANCE\n\n-Y 1 +X 4\n" + pixels.substr(4) + "\1\1\1\3");
  const Image repeated = read_image(path("b.hdr"));
  for (int x = 0; x < 4; ++x) EXPECT_NEAR(repeated.at(x, 0, 1), 64.5 / 256, 1e-6);
}

TEST_F(RoundTrip, hdr_keeps_the_field_of_view) {
  Image image(2, 1, {"R", "G", "B"});
  write_image(image, path("without.hdr"));
  EXPECT_FALSE(field_of_view(read_image(path("without.hdr"))));
  image.set_metadata("horizontal_fov", 45.5);
  image.set_metadata("vertical_fov", 30.25);
  write_image(image, path("with.hdr"));
  EXPECT_EQ(field_of_view(read_image(path("with.hdr")))->horizontal, 45.5f);
  EXPECT_EQ(field_of_view(read_image(path("with.hdr")))->vertical, 30.25f);

  const auto view_of = [&](const std::string& line) {
    put(path("other.hdr"),
        "#?RADIANCE\n" + line + "FORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" + std::string(4, 'x'));
    return field_of_view(read_image(path("other.hdr")));
  };
  const auto view = view_of("VIEW= -vtv -vp 1 2 3 -vd 0 1 0 -vu 0 0 1 -vh 60 -vv 40 -vs 0 -vl 0\n");
  EXPECT_EQ(view->horizontal, 60);
  EXPECT_EQ(view->vertical, 40);
  EXPECT_FALSE(view_of("VIEW= -vta -vh 180 -vv 180\n"));  // a fisheye
  EXPECT_FALSE(view_of("VIEW= -vtv -vh many\n"));
}

TEST_F(RoundTrip, logluv_keeps_luminance_within_its_step) {
  const Image image = test_picture(200, 30, 12);
  const Image back = written_and_read(image, "a.tif");
  const RgbView x = rgb_view(image), y = rgb_view(back);
  double mean_log = 0, largest = 0;
  for (size_t i = 0; i < image.pixel_count(); ++i) {
    const double log_ratio = std::log(double(photopic(y[i])) / double(photopic(x[i])));
    largest = std::max(largest, std::fabs(log_ratio));
    if (i >= image.pixel_count() / 3)  // not over the area of equal pixels
      mean_log += log_ratio / double(image.pixel_count() * 2 / 3);
    // 8 bits for each chromaticity coordinate.
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(y[i][c], x[i][c], 0.05f * std::max({x[i].x, x[i].y, x[i].z}));
  }
  EXPECT_LE(largest, 0.003);
  EXPECT_LT(std::fabs(mean_log), 1e-4);
}

TEST_F(RoundTrip, logluv_is_absolute) {
  Image image(16, 16, {"R", "G", "B"});
  for (int c = 0; c < 3; ++c) std::fill(image.channel(c).begin(), image.channel(c).end(), 2.0f);
  write_image(image, path("a.tif"));
  TIFF* tiff = TIFFOpen(path("a.tif").c_str(), "r");
  ASSERT_TRUE(tiff);
  double candelas = 0;
  uint16_t photometric = 0, compression = 0;
  EXPECT_TRUE(TIFFGetField(tiff, TIFFTAG_STONITS, &candelas));
  TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &photometric);
  TIFFGetField(tiff, TIFFTAG_COMPRESSION, &compression);
  EXPECT_EQ(photometric, PHOTOMETRIC_LOGLUV);
  EXPECT_EQ(compression, COMPRESSION_SGILOG);
  TIFFSetField(tiff, TIFFTAG_SGILOGDATAFMT, SGILOGDATAFMT_FLOAT);
  std::vector<float> xyz(3 * 16);
  EXPECT_EQ(TIFFReadScanline(tiff, xyz.data(), 0, 0), 1);
  EXPECT_NEAR(double(xyz[1]) * candelas, 358, 358 * 0.003);
  TIFFClose(tiff);
}

TEST_F(RoundTrip, logluv_black_and_non_finite) {
  Image image(8, 2, {"R", "G", "B"});
  image.at(1, 0, 0) = std::numeric_limits<float>::quiet_NaN();
  image.at(2, 0, 1) = std::numeric_limits<float>::infinity();
  const Image back = written_and_read(image, "a.tif");
  for (int c = 0; c < 3; ++c)
    for (const float value : back.channel(c)) EXPECT_EQ(value, 0);
}

TEST_F(RoundTrip, text_metadata_of_png_and_tiff) {
  Image image = test_picture(4, 4, 1);
  image.set_metadata("scene", std::string("box"));
  image.set_metadata("author", std::string("J\xc3\xb6rg"));
  image.set_metadata("passes", int64_t{64});
  for (const char* name : {"a.png", "a.tif"}) {
    const Image back = written_and_read(image, name);
    ASSERT_TRUE(back.find_metadata("scene")) << name;
    EXPECT_EQ(std::get<std::string>(*back.find_metadata("scene")), "box");
    EXPECT_EQ(std::get<std::string>(*back.find_metadata("author")), "J\xc3\xb6rg");
    EXPECT_EQ(std::get<std::string>(*back.find_metadata("passes")), "64");
  }
}

class EightBit : public RoundTrip {};

TEST_F(EightBit, srgb_is_linear_again_after_reading) {
  Image image(64, 64, {"R", "G", "B"});
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = float(x + y + 20 * c) / 170;
  WriteOptions options;
  options.tone = make_tone_operator("srgb");
  for (const auto& [name, tolerance] :
       {std::pair("a.png", 0.5f / 255), std::pair("a.ppm", 0.5f / 255),
        std::pair("a.jpg", 8.0f / 255)}) {
    write_image(image, path(name), options);
    const Image linear = read_image(path(name));
    ReadOptions raw;
    raw.srgb_to_linear = false;
    const Image encoded = read_image(path(name), raw);
    EXPECT_FALSE(linear.is_srgb_encoded());
    EXPECT_TRUE(encoded.is_srgb_encoded());
    for (size_t i = 0; i < image.pixel_count(); ++i)
      for (int c = 0; c < 3; ++c) {
        ASSERT_NEAR(encoded.channel(c)[i], srgb_from_linear(image.channel(c)[i]), tolerance * 1.01f)
            << name;
        ASSERT_NEAR(linear.channel(c)[i], linear_from_srgb(encoded.channel(c)[i]), 1e-6);
      }
  }
}

TEST_F(EightBit, layers_can_be_chosen) {
  Image image(4, 4, {"R", "G", "B", "direct.R", "direct.G", "direct.B"});
  for (float& value : image.channel(3)) value = 1;
  WriteOptions options;
  options.tone = make_tone_operator("srgb");
  options.layer = "direct";
  const Image back = written_and_read(image, "a.png", options);
  EXPECT_EQ(back.at(0, 0, 0), 1);
  EXPECT_EQ(back.at(0, 0, 1), 0);
  options.layer = "nothing";
  expect_input_error([&] { write_image(image, path("b.png"), options); }, "'nothing'");
}

TEST_F(EightBit, shown_pictures_go_to_every_format_for_displays) {
  const Image image = testing::test_picture(40, 30, 1);
  Image shown = tone_map(image, *make_tone_operator("srgb"));
  shown.set_metadata("scene", std::string("a b"));
  for (const char* name : {"a.png", "a.ppm", "a.tif", "a.tiff"}) {
    write_shown_image(shown, path(name));
    const Image back = read_image(path(name), {.srgb_to_linear = false});
    EXPECT_TRUE(back.is_srgb_encoded()) << name;
    ASSERT_EQ(back.width(), 40);
    for (int c = 0; c < 3; ++c)
      for (size_t i = 0; i < back.pixel_count(); ++i)
        ASSERT_NEAR(back.channel(c)[i], srgb_from_linear(shown.channel(c)[i]), 0.51 / 255) << name;
  }
  EXPECT_EQ(std::get<std::string>(*read_image(path("a.tif")).find_metadata("scene")), "a b");
  for (const char* name : {"a.exr", "a.hdr", "a.pfm"})
    testing::expect_input_error([&] { write_shown_image(shown, path(name)); },
                                "is no format for displays");
}

TEST_F(EightBit, limits_of_jpeg_are_told) {
  WriteOptions options;
  options.jpeg_quality = 101;
  expect_input_error([&] { write_image(Image(2, 2, {"Y"}), path("a.jpg"), options); }, "quality");
  expect_input_error([&] { write_image(Image(65501, 1, {"Y"}), path("a.jpg")); }, "65500");
}

// 16-bit floats end at 6e-8 and are coarse below 6e-5.
TEST_F(RoundTrip, dim_pictures_keep_their_values) {
  const auto error_of = [&](const Image& image) {
    write_image(image, path("dim.exr"));
    const Image read = read_image(path("dim.exr"));
    double worst = 0;
    for (size_t i = 0; i < image.pixel_count(); ++i)
      worst = std::max(worst, std::fabs(double(read.channel(read.find_channel("R"))[i]) /
                                            double(image.channel(0)[i]) -
                                        1));
    return worst;
  };
  Image image(40, 30, {"R", "G", "B"});
  const auto fill = [&](float value) { std::ranges::fill(image.channel(0), value); };
  for (const float level : {1e-8f, 1e-7f, 3e-6f, 1e-4f, 1.0f}) {
    fill(level);
    EXPECT_LT(error_of(image), 1.0 / 2048) << level;
  }
  // A dim corner of a bright picture.
  fill(1);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 3; ++x) image.at(x, y, 0) = 1e-8f;
  EXPECT_LT(error_of(image), 1.0 / 2048);
  // One such pixel is no picture: the channel stays short.
  fill(1);
  image.at(5, 5, 0) = 1e-9f;
  EXPECT_EQ(error_of(image), 1);
  // In RGBE and LogLuv to their steps.
  fill(1e-8f);
  for (int c = 1; c < 3; ++c) std::ranges::fill(image.channel(c), 1e-8f);
  for (const char* name : {"dim.hdr", "dim.tif"}) {
    write_image(image, path(name));
    EXPECT_NEAR(read_image(path(name)).channel(1)[7] / 1e-8f, 1, 0.02) << name;
  }
}

}  // namespace
}  // namespace kaustik
