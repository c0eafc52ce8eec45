#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <OpenEXR/ImfTiledOutputPart.h>
#include <OpenEXR/ImfTiledRgbaFile.h>
#include <png.h>
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

TEST_F(RoundTrip, text_and_grey_pnm) {
  put(path("a.ppm"), "P3\n# comment\n2 1\n# another\n100\n0 50 100  100 0 0\n");
  ReadOptions raw;
  raw.srgb_to_linear = false;
  const Image text = read_image(path("a.ppm"), raw);
  EXPECT_EQ(text.at(0, 0, 1), 0.5f);
  EXPECT_EQ(text.at(1, 0, 0), 1);
  put(path("b.pgm"), std::string("P5 1 2 65535\n\x80\x00\xff\xff", 17));
  const Image grey = read_image(path("b.pgm"), raw);
  EXPECT_EQ(grey.channel_names(), std::vector<std::string>{"Y"});
  EXPECT_NEAR(grey.at(0, 0, 0), 32768 / 65535.0, 1e-6);
  EXPECT_EQ(grey.at(0, 1, 0), 1);
}

TEST_F(RoundTrip, plain_tiff_in_lines_and_tiles) {
  for (const bool is_tiled : {false, true})
    for (const int bits : {8, 16, 32}) {
      TIFF* tiff = TIFFOpen(path("a.tif").c_str(), "w");
      TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, 20);
      TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, 18);
      TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 3);
      TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, bits);
      TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT,
                   bits == 32 ? SAMPLEFORMAT_IEEEFP : SAMPLEFORMAT_UINT);
      TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB);
      TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
      if (is_tiled) {
        TIFFSetField(tiff, TIFFTAG_TILEWIDTH, 16);
        TIFFSetField(tiff, TIFFTAG_TILELENGTH, 16);
      }
      // Value x / 20 in red, y / 20 in green.
      const auto fill = [&](std::vector<uint8_t>& buffer, int x0, int y0, int width, int height) {
        for (int y = 0; y < height; ++y)
          for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c) {
              const float value = c == 0 ? float(x0 + x) / 40 : c == 1 ? float(y0 + y) / 40 : 1;
              const size_t i = size_t((y * width + x) * 3 + c);
              if (bits == 8) buffer[i] = uint8_t(value * 255 + 0.5f);
              if (bits == 16)
                reinterpret_cast<uint16_t*>(buffer.data())[i] = uint16_t(value * 65535);
              if (bits == 32) reinterpret_cast<float*>(buffer.data())[i] = value;
            }
      };
      std::vector<uint8_t> buffer(20 * 16 * 12);
      if (is_tiled) {
        for (int y = 0; y < 18; y += 16)
          for (int x = 0; x < 20; x += 16) {
            fill(buffer, x, y, 16, 16);
            TIFFWriteTile(tiff, buffer.data(), uint32_t(x), uint32_t(y), 0, 0);
          }
      } else {
        for (int y = 0; y < 18; ++y) {
          fill(buffer, 0, y, 20, 1);
          TIFFWriteScanline(tiff, buffer.data(), uint32_t(y), 0);
        }
      }
      TIFFClose(tiff);
      ReadOptions raw;
      raw.srgb_to_linear = false;
      const Image image = read_image(path("a.tif"), raw);
      EXPECT_EQ(image.is_srgb_encoded(), bits != 32);
      for (int y = 0; y < 18; ++y)
        for (int x = 0; x < 20; ++x) {
          ASSERT_NEAR(image.at(x, y, 0), float(x) / 40, 0.002) << bits << is_tiled;
          ASSERT_NEAR(image.at(x, y, 1), float(y) / 40, 0.002) << bits << is_tiled;
        }
    }
}

TEST_F(RoundTrip, tiled_exr_with_an_offset) {
  const Imath::Box2i display({0, 0}, {99, 99}), data({30, 20}, {30 + 69, 20 + 44});
  for (const Imf::Compression compression :
       {Imf::NO_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::DWAA_COMPRESSION}) {
    std::vector<Imf::Rgba> pixels(70 * 45);
    for (size_t i = 0; i < pixels.size(); ++i)
      pixels[i] = Imf::Rgba(float(i % 70) / 64, float(i / 70) / 64, 0.5f, 1.0f);
    {
      Imf::TiledRgbaOutputFile file(path("a.exr").c_str(), 32, 16, Imf::ONE_LEVEL, Imf::ROUND_DOWN,
                                    display, data, Imf::WRITE_RGBA, 1, Imath::V2f(0, 0), 1,
                                    Imf::INCREASING_Y, compression);
      file.setFrameBuffer(pixels.data() - 30 - 20 * 70, 1, 70);
      file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
    }
    const Image image = read_image(path("a.exr"));
    ASSERT_EQ(image.width(), 70);
    ASSERT_EQ(image.height(), 45);
    const RgbView rgb = rgb_view(image);
    const float tolerance = compression == Imf::DWAA_COMPRESSION ? 0.02f : 1e-3f;  // DWA is lossy
    for (size_t i = 0; i < pixels.size(); ++i) {
      ASSERT_NEAR(rgb[i].x, float(i % 70) / 64, tolerance);
      ASSERT_NEAR(rgb[i].y, float(i / 70) / 64, tolerance);
    }
    EXPECT_EQ(image.at(3, 3, image.find_channel("A")), 1);
  }
}

/// Planes of a picture as OpenEXR takes them; `values` outlives the buffer.
template <typename T>
void insert_plane(Imf::FrameBuffer& buffer, const char* name, Imf::PixelType type,
                  std::vector<T>& values, size_t width) {
  buffer.insert(
      name, Imf::Slice(type, reinterpret_cast<char*>(values.data()), sizeof(T), sizeof(T) * width));
}

TEST_F(RoundTrip, exr_of_every_pixel_type) {
  constexpr int width = 5, height = 3;
  std::vector<::half> halves(width * height, ::half(0.5f));
  std::vector<float> floats(width * height, 1e-9f);
  std::vector<unsigned> integers(width * height, 3000000000u);
  for (const bool is_tiled : {false, true}) {
    Imf::Header header(width, height);
    header.channels().insert("R", Imf::Channel(Imf::HALF));
    header.channels().insert("G", Imf::Channel(Imf::FLOAT));
    header.channels().insert("B", Imf::Channel(Imf::UINT));
    Imf::FrameBuffer buffer;
    insert_plane(buffer, "R", Imf::HALF, halves, width);
    insert_plane(buffer, "G", Imf::FLOAT, floats, width);
    insert_plane(buffer, "B", Imf::UINT, integers, width);
    if (is_tiled) {
      header.setTileDescription(Imf::TileDescription(2, 2, Imf::ONE_LEVEL));
      Imf::TiledOutputFile file(path("a.exr").c_str(), header);
      file.setFrameBuffer(buffer);
      file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
    } else {
      Imf::OutputFile file(path("a.exr").c_str(), header);
      file.setFrameBuffer(buffer);
      file.writePixels(height);
    }
    const Image image = read_image(path("a.exr"));
    const RgbView rgb = rgb_view(image);
    for (size_t i = 0; i < width * height; ++i) EXPECT_EQ(rgb[i], Vec3f(0.5f, 1e-9f, 3e9f));
    EXPECT_FALSE(image.keeps_floats(image.find_channel("R")));
    EXPECT_TRUE(image.keeps_floats(image.find_channel("B")));
  }
}

/// Channels of all parts, under the names of their parts where they would be the same.
TEST_F(RoundTrip, exr_of_several_parts) {
  constexpr int width = 6, height = 4;
  struct Part {
    const char* name;
    std::vector<const char*> channels;
    bool is_tiled;
    int width;
  };
  const std::vector<Part> parts = {{"depth", {"Z"}, false, width},
                                   {"rgba", {"R", "G", "B"}, true, width},
                                   {"small", {"small.R"}, false, width - 1},
                                   {"normal", {"R", "G", "B"}, false, width}};
  std::vector<Imf::Header> headers;
  for (const Part& part : parts) {
    headers.emplace_back(width, height);
    headers.back().dataWindow().max.x = part.width - 1;
    headers.back().setName(part.name);
    headers.back().setType(part.is_tiled ? Imf::TILEDIMAGE : Imf::SCANLINEIMAGE);
    if (part.is_tiled)
      headers.back().setTileDescription(Imf::TileDescription(4, 4, Imf::ONE_LEVEL));
    for (const char* channel : part.channels)
      headers.back().channels().insert(channel, Imf::Channel(Imf::FLOAT));
  }
  {
    Imf::MultiPartOutputFile file(path("a.exr").c_str(), headers.data(), int(headers.size()));
    for (size_t i = 0; i < parts.size(); ++i) {
      std::vector<std::vector<float>> planes;
      for (size_t c = 0; c < parts[i].channels.size(); ++c) {
        planes.emplace_back(width * height);
        for (size_t k = 0; k < planes[c].size(); ++k)
          planes[c][k] = float(100 * i + 10 * c) + float(k);
      }
      Imf::FrameBuffer buffer;
      for (size_t c = 0; c < planes.size(); ++c)
        insert_plane(buffer, parts[i].channels[c], Imf::FLOAT, planes[c], size_t(parts[i].width));
      if (parts[i].is_tiled) {
        Imf::TiledOutputPart part(file, int(i));
        part.setFrameBuffer(buffer);
        part.writeTiles(0, part.numXTiles() - 1, 0, part.numYTiles() - 1);
      } else {
        Imf::OutputPart part(file, int(i));
        part.setFrameBuffer(buffer);
        part.writePixels(height);
      }
    }
  }
  const Image image = read_image(path("a.exr"));
  std::vector<std::string> names = image.channel_names();
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names,
            (std::vector<std::string>{"B", "G", "R", "Z", "normal.B", "normal.G", "normal.R"}));
  const RgbView rgb = rgb_view(image), normal = rgb_view(image, "normal");
  for (size_t i = 0; i < width * height; ++i) {
    const float k = float(i);
    EXPECT_EQ(rgb[i], Vec3f(100 + k, 110 + k, 120 + k));
    EXPECT_EQ(normal[i], Vec3f(300 + k, 310 + k, 320 + k));
    EXPECT_EQ(image.channel(image.find_channel("Z"))[i], k);
  }
  // Cut anywhere it is an error or a picture.
  const std::string whole = contents(path("a.exr"));
  for (size_t length = 0; length < whole.size(); length += 7) {
    put(path("cut.exr"), whole.substr(0, length));
    testing::caught([&] { read_image(path("cut.exr")); });
  }
}

TEST_F(RoundTrip, constant_pictures_of_extreme_compression) {
  // Nearly nothing per pixel, yet no corrupt header.
  const Image image(1000, 1000, {"R", "G", "B"});
  for (const char* name : {"a.exr", "a.hdr", "a.tif", "a.png", "a.jpg"})
    EXPECT_EQ(written_and_read(image, name).at(999, 999, 2), 0) << name;
  const Imath::Box2i window({0, 0}, {999, 999});
  const std::vector<Imf::Rgba> pixels(1000 * 1000);
  for (const Imf::Compression compression :
       {Imf::RLE_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::PXR24_COMPRESSION, Imf::B44A_COMPRESSION,
        Imf::DWAA_COMPRESSION, Imf::DWAB_COMPRESSION}) {
    {
      Imf::Header header(window, window);
      header.compression() = compression;
      Imf::RgbaOutputFile file(path("b.exr").c_str(), header, Imf::WRITE_RGBA);
      file.setFrameBuffer(pixels.data(), 1, 1000);
      file.writePixels(1000);
    }
    EXPECT_EQ(read_image(path("b.exr")).at(999, 999, 2), 0) << compression;
  }
}

TEST_F(RoundTrip, linear_sixteen_bit_png_stays_linear) {
  const std::vector<uint16_t> pixels = {0, 0, 32768, 65535, 65535, 65535};
  png_image description = {};
  description.version = PNG_IMAGE_VERSION;
  description.width = 2;
  description.height = 1;
  description.format = PNG_FORMAT_LINEAR_RGB;
  ASSERT_TRUE(
      png_image_write_to_file(&description, path("a.png").c_str(), 0, pixels.data(), 0, nullptr));
  ReadOptions raw;
  raw.srgb_to_linear = false;
  EXPECT_FALSE(read_image(path("a.png"), raw).is_srgb_encoded());
  EXPECT_NEAR(read_image(path("a.png")).at(0, 0, 2), 32768.0 / 65535, 1e-6);
}

/// Seven passes over a picture whose sizes none of them divides.
TEST_F(RoundTrip, interlaced_png_of_sixteen_bits) {
  for (const auto& [width, height] : {std::pair(13, 11), {1, 1}, {3, 1}, {1, 9}}) {
    const auto value = [](int x, int y, int c) { return 4000 * x + 300 * y + c; };
    std::vector<std::string> rows;
    for (int y = 0; y < height; ++y) {
      rows.emplace_back();
      for (int x = 0; x < width; ++x)
        for (int c = 0; c < 3; ++c)
          rows.back() += {char(value(x, y, c) >> 8), char(value(x, y, c) & 255)};
    }
    ReadOptions raw;
    raw.srgb_to_linear = false;
    for (const bool is_interlaced : {false, true}) {
      put(path("a.png"),
          testing::png_of(width, height, 16, PNG_COLOR_TYPE_RGB, is_interlaced, rows));
      const Image image = read_image(path("a.png"), raw);
      ASSERT_EQ(image.width(), width);
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
          for (int c = 0; c < 3; ++c)
            ASSERT_FLOAT_EQ(image.at(x, y, c), float(value(x, y, c)) / 65535) << is_interlaced;
    }
  }
}

TEST_F(RoundTrip, png_of_few_bits) {
  ReadOptions raw;
  raw.srgb_to_linear = false;
  for (const bool is_interlaced : {false, true}) {
    // 0 1 2 3 and 3 0 1 2 of two bits.
    put(path("a.png"), testing::png_of(4, 2, 2, PNG_COLOR_TYPE_GRAY, is_interlaced,
                                       {std::string(1, '\x1b'), std::string(1, '\xc6')}));
    const Image image = read_image(path("a.png"), raw);
    ASSERT_EQ(image.channel_count(), 1);
    for (int x = 0; x < 4; ++x) {
      EXPECT_FLOAT_EQ(image.at(x, 0, 0), float(x) / 3);
      EXPECT_FLOAT_EQ(image.at(x, 1, 0), float((x + 3) % 4) / 3);
    }
  }
}

TEST_F(RoundTrip, png_palettes_and_opacity) {
  // Index 1 of two colours, the first half transparent; opacity is never sRGB encoded.
  const std::vector<uint8_t> indices = {1, 0};
  const std::vector<uint8_t> colours = {255, 128, 0, 128, 0, 0, 255, 255};
  png_image description = {};
  description.version = PNG_IMAGE_VERSION;
  description.width = 2;
  description.height = 1;
  description.format = PNG_FORMAT_RGBA_COLORMAP;
  description.colormap_entries = 2;
  ASSERT_TRUE(png_image_write_to_file(&description, path("a.png").c_str(), 0, indices.data(), 0,
                                      colours.data()));
  const Image image = read_image(path("a.png"));
  ASSERT_EQ(image.channel_count(), 4);
  EXPECT_EQ(image.at(0, 0, 2), 1);
  EXPECT_NEAR(image.at(1, 0, 1), 0.21586, 1e-4);
  EXPECT_NEAR(image.at(1, 0, 3), 128 / 255.0, 1e-6);
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
