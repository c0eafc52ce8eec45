// Damaged files: an error or an image, never a crash, a hang or a giant allocation.

#include <OpenEXR/ImfTiledRgbaFile.h>
#include <sys/resource.h>
#include <tiffio.h>

#include <cstring>
#include <limits>

#include "kaustik/image/image_io.h"
#include "tests/image/child.h"
#include "tests/image/samples.h"
#include "tests/image/support.h"

namespace kaustik {
namespace {

using testing::expect_input_error;

#ifdef KAUSTIK_SLOW_BUILD
constexpr int flips_per_format = 300;
#else
constexpr int flips_per_format = 3000;
#endif

class Hostile : public testing::FileTest {
 protected:
  /// An error must be an input error, or one of memory, that names the file and a remedy.
  bool reads(const std::string& bytes) const {
    const std::string file = path("damaged.tga");  // what is nothing else is read as TGA
    put(file, bytes);
    const testing::Caught error = testing::caught([&] { read_image(file); });
    if (!error.is_error) return true;
    if (error.text.find("memory") == std::string::npos) {
      EXPECT_EQ(error.kind, ErrorKind::input) << error.text;
    }
    EXPECT_NE(error.text.find(file), std::string::npos) << error.text;
    EXPECT_FALSE(error.remedy.empty());
    return false;
  }
  /// A file of each format, from an image so small that damage often meets the header.
  std::vector<std::string> corpus() const {
    Image image = testing::test_picture(24, 13, 3);
    image.set_metadata("scene", std::string("box"));
    std::vector<std::string> files;
    for (const char* name : {"a.exr", "a.hdr", "a.pfm", "a.tif", "a.png", "a.jpg", "a.ppm"}) {
      write_image(image, path(name));
      files.push_back(contents(path(name)));
    }
    for (const Imf::Compression compression :
         {Imf::RLE_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::B44_COMPRESSION, Imf::DWAA_COMPRESSION})
      files.push_back(tiled_exr(compression));
    files.push_back(tiled_tiff());
    for (const std::string& file : {testing::bmp_with_runs(), testing::bmp_with_masks(),
                                    testing::tga_with_runs(), testing::webp_picture(24, 13)})
      files.push_back(file);
    files.push_back(testing::cmyk_jpeg(24, 13, true));
    files.push_back(testing::luminance_chroma_exr(path("chroma.exr"), 24, 14));
    return files;
  }

  std::string tiled_exr(Imf::Compression compression) const {
    std::vector<Imf::Rgba> pixels(24 * 13);
    for (size_t i = 0; i < pixels.size(); ++i)
      pixels[i] = Imf::Rgba(float(i % 24), float(i / 24), float(i * i % 7), 1);
    {
      Imf::TiledRgbaOutputFile file(path("tiled.exr").c_str(), 24, 13, 16, 8, Imf::MIPMAP_LEVELS,
                                    Imf::ROUND_DOWN, Imf::WRITE_RGBA, 1, Imath::V2f(0, 0), 1,
                                    Imf::INCREASING_Y, compression);
      file.setFrameBuffer(pixels.data(), 1, 24);
      for (int level = 0; level < file.numLevels(); ++level)
        file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
    }
    return contents(path("tiled.exr"));
  }

  std::string tiled_tiff() const {
    TIFF* tiff = TIFFOpen(path("tiled.tif").c_str(), "w");
    for (const auto& [tag, value] :
         {std::pair(TIFFTAG_IMAGEWIDTH, 24), std::pair(TIFFTAG_IMAGELENGTH, 13),
          std::pair(TIFFTAG_SAMPLESPERPIXEL, 3), std::pair(TIFFTAG_BITSPERSAMPLE, 16),
          std::pair(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB), std::pair(TIFFTAG_TILEWIDTH, 16),
          std::pair(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG), std::pair(TIFFTAG_TILELENGTH, 16),
          std::pair(TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE)})
      TIFFSetField(tiff, uint32_t(tag), value);
    std::vector<uint16_t> tile(16 * 16 * 3);
    for (size_t i = 0; i < tile.size(); ++i) tile[i] = uint16_t(i * i);
    for (uint32_t x = 0; x < 24; x += 16) TIFFWriteTile(tiff, tile.data(), x, 0, 0, 0);
    TIFFClose(tiff);
    return contents(path("tiled.tif"));
  }
};

TEST_F(Hostile, truncated_files_are_refused) {
  for (const std::string& file : corpus()) {
    ASSERT_TRUE(reads(file));
    for (const double share : {0.0, 0.02, 0.1, 0.3, 0.5, 0.6})
      EXPECT_FALSE(reads(file.substr(0, size_t(share * double(file.size())))))
          << file.substr(0, 4) << " cut at " << share;
    // Anywhere, and in the very end, where smaller levels or trailing bytes may not matter.
    for (size_t length = 1; length < file.size(); length += 1 + file.size() / 300)
      reads(file.substr(0, length));
    for (size_t cut = 1; cut < 20; ++cut) reads(file.substr(0, file.size() - cut));
  }
}

TEST_F(Hostile, damaged_bytes_do_no_harm) {
  std::mt19937 generator(3);
  for (const std::string& file : corpus()) {
    int refused = 0;
    for (int i = 0; i < flips_per_format; ++i) {
      std::string damaged = file;
      // Half of the damage to the header, where sizes are.
      const size_t reach = i % 2 ? file.size() : std::min(file.size(), size_t{200});
      const int count = 1 + int(generator() % 3);
      for (int k = 0; k < count; ++k) {
        const unsigned kind = generator() % 3;
        char& byte = damaged[generator() % reach];
        byte = kind == 0   ? char(generator())
               : kind == 1 ? '\xff'
                           : char(byte ^ (1 << generator() % 8));
      }
      refused += reads(damaged) ? 0 : 1;
    }
    EXPECT_GT(refused, 0) << file.substr(0, 4);
  }
  // Corrupt headers must not have made us touch gigabytes.
  rusage usage = {};
  ::getrusage(RUSAGE_SELF, &usage);
#ifndef KAUSTIK_SLOW_BUILD
  EXPECT_LT(usage.ru_maxrss, 1000000);  // kilobytes
#endif
}

TEST_F(Hostile, headers_that_promise_too_much) {
  const auto refuses = [&](const std::string& bytes) { EXPECT_FALSE(reads(bytes)) << bytes; };
  refuses("PF\n1000000 1000000\n-1\n");
  refuses("PF\n20000 20000\n-1\nabc");
  refuses("Pf\n99999999999999999999 1\n-1\nabc");
  refuses("PF\n2 2\n0\n" + std::string(48, 'x'));
  refuses("PF\n2 2\nnan\n" + std::string(48, 'x'));
  refuses("PF\n-2 2\n-1\n" + std::string(48, 'x'));
  refuses("P6\n100000 100000\n255\nabc");
  refuses("P6\n2 2\n0\n" + std::string(12, 'x'));
  refuses("P6\n2 2\n70000\n" + std::string(24, 'x'));
  refuses("P3\n2 2\n255\n1 2 3");
  refuses("P3\n1 1\n255\n1 2 300");
  refuses("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2000000000 +X 2000000000\nabcd");
  refuses("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 20000 +X 20000\nabcd");
  refuses("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 99999999999999 +X 1\nabcd");
  refuses("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y -3 +X -4\nabcd");
  refuses("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-X 3 +X 4\n" + std::string(48, 'x'));
  refuses("#?RADIANCE\nFORMAT=other\n\n-Y 1 +X 1\nabcd");
  refuses("#?RADIANCE\nEXPOSURE=0\n\n-Y 1 +X 1\nabcd");
  refuses("#?RADIANCE\n\n-Y 1 +X 4\n" + std::string("\1\1\1\3", 4));  // repeats nothing
  refuses("#?RADIANCE\n" + std::string(1000000, 'x'));
}

#ifndef KAUSTIK_SLOW_BUILD
// A header that tells of more pixels than any memory holds, or than the file can hold.
TEST_F(Hostile, exr_windows_that_promise_too_much) {
  write_image(testing::test_picture(24, 13, 3), path("a.exr"));
  for (const int32_t last : {99'999, 1 << 30, std::numeric_limits<int32_t>::max() - 1,
                             std::numeric_limits<int32_t>::max()})
    for (const int32_t first : {0, std::numeric_limits<int32_t>::min()}) {
      std::string file = contents(path("a.exr"));
      for (const char* window : {"dataWindow", "displayWindow"}) {
        const std::string head = std::string(window) + '\0' + "box2i" + '\0';
        const size_t at = file.find(head);
        ASSERT_NE(at, std::string::npos);
        const int32_t corners[] = {first, first, last, last};
        std::memcpy(file.data() + at + head.size() + 4, corners, sizeof(corners));
      }
      SCOPED_TRACE(std::to_string(first) + " to " + std::to_string(last));
      EXPECT_LT(testing::memory_growth([&] { reads(file); }), 100'000'000);
      EXPECT_FALSE(reads(file));
    }
}
#endif

TEST_F(Hostile, what_is_no_image_at_all) {
  EXPECT_FALSE(reads(""));
  EXPECT_FALSE(reads("x"));
  EXPECT_FALSE(reads("<scene version=\"3.0.0\"/>"));
  EXPECT_FALSE(reads(std::string(1000, '\0')));
  expect_input_error([&] { read_image(path("missing.exr")); }, path("missing.exr"));
  expect_input_error([&] { read_image(folder_.string()); }, "regular");
}

}  // namespace
}  // namespace kaustik
