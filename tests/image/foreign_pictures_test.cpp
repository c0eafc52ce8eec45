// Pictures that other programs wrote, as their libraries do.

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
#include "tests/image/samples.h"
#include "tests/image/support.h"

namespace kaustik {
namespace {

class ForeignPictures : public testing::FileTest {};

TEST_F(ForeignPictures, text_and_grey_pnm) {
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

TEST_F(ForeignPictures, plain_tiff_in_lines_and_tiles) {
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

TEST_F(ForeignPictures, tiled_exr_with_an_offset) {
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

TEST_F(ForeignPictures, exr_of_every_pixel_type) {
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
TEST_F(ForeignPictures, exr_of_several_parts) {
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

TEST_F(ForeignPictures, constant_pictures_of_extreme_compression) {
  // Nearly nothing per pixel, yet no corrupt header.
  const Image image(1000, 1000, {"R", "G", "B"});
  for (const char* name : {"a.exr", "a.hdr", "a.tif", "a.png", "a.jpg"})
    EXPECT_EQ((write_image(image, path(name)), read_image(path(name))).at(999, 999, 2), 0) << name;
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

TEST_F(ForeignPictures, linear_sixteen_bit_png_stays_linear) {
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
TEST_F(ForeignPictures, interlaced_png_of_sixteen_bits) {
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

TEST_F(ForeignPictures, png_of_few_bits) {
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

TEST_F(ForeignPictures, png_palettes_and_opacity) {
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

}  // namespace
}  // namespace kaustik
