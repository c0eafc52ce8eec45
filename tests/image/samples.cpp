#include "tests/image/samples.h"

#include <OpenEXR/ImfRgbaFile.h>
#include <png.h>
#include <webp/encode.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
// jpeglib.h needs the standard headers above it.
#include <jpeglib.h>

namespace kaustik::testing {

std::string u16(int value) { return {char(value & 255), char(value >> 8 & 255)}; }
std::string u32(uint32_t value) { return u16(int(value & 0xffff)) + u16(int(value >> 16)); }

std::string bmp(int width, int height, int bits, int compression, const std::string& palette,
                const std::string& pixels) {
  const std::string info = u32(40) + u32(uint32_t(width)) + u32(uint32_t(height)) + u16(1) +
                           u16(bits) + u32(uint32_t(compression)) + u32(uint32_t(pixels.size())) +
                           std::string(8, '\0') +
                           u32(bits <= 8 ? uint32_t(palette.size() / 4) : 0) + u32(0);
  const auto start = uint32_t(14 + info.size() + palette.size());
  return "BM" + u32(start + uint32_t(pixels.size())) + u32(0) + u32(start) + info + palette +
         pixels;
}

std::string bmp_with_runs() {
  const std::string palette(
      "\0\0\0\0"
      "\0\0\377\0"
      "\0\377\0\0"
      "\377\0\0\0",
      16);
  // From below: a run of 8; a jump by (2, 0) and three values as they are; an empty line; a run.
  const std::string pixels(
      "\10\1\0\0"
      "\0\2\2\0\0\3\1\2\3\0\0\0"
      "\0\0"
      "\4\2\0\1",
      22);
  return bmp(8, 4, 8, 1, palette, pixels);
}

std::string bmp_with_masks() {
  const std::string masks = u32(0xff) + u32(0xff00) + u32(0xff0000) + u32(0xff000000);
  return bmp(2, 2, 32, 6, masks,
             u32(0x80030201) + u32(0x80060504) + u32(0xff090807) + u32(0x000c0b0a));
}

std::string tga(int type, int width, int height, int depth, int flags, const std::string& pixels) {
  return std::string{0, 0, char(type)} + std::string(9, '\0') + u16(width) + u16(height) +
         std::string{char(depth), char(flags)} + pixels;
}

std::string tga_with_runs() {
  // Top down. A run of 6 over the line's end, then 6 pixels as they are.
  std::string pixels("\205\1\2\3\5", 5);
  for (int i = 0; i < 18; ++i) pixels += char(10 * i);
  return tga(10, 4, 3, 24, 0x20, pixels);
}

std::string webp_picture(int width, int height) {
  std::vector<uint8_t> rgb;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (const int value : {10 * x, 10 * y, 200}) rgb.push_back(uint8_t(value));
  uint8_t* bytes = nullptr;
  const size_t size = WebPEncodeLosslessRGB(rgb.data(), width, height, 3 * width, &bytes);
  std::string file(reinterpret_cast<const char*>(bytes), size);
  WebPFree(bytes);
  return file;
}

std::string cmyk_jpeg(int width, int height, bool by_adobe) {
  jpeg_error_mgr errors;
  jpeg_compress_struct codec = {};
  codec.err = jpeg_std_error(&errors);
  jpeg_create_compress(&codec);
  unsigned char* buffer = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&codec, &buffer, &size);
  codec.image_width = JDIMENSION(width);
  codec.image_height = JDIMENSION(height);
  codec.input_components = 4;
  codec.in_color_space = JCS_CMYK;
  jpeg_set_defaults(&codec);
  jpeg_set_quality(&codec, 100, TRUE);
  codec.write_Adobe_marker = by_adobe ? TRUE : FALSE;
  jpeg_start_compress(&codec, TRUE);
  std::vector<uint8_t> row;
  for (int x = 0; x < width; ++x)
    for (const int ink : {51, 0, 153, 128}) row.push_back(uint8_t(by_adobe ? 255 - ink : ink));
  while (codec.next_scanline < codec.image_height) {
    JSAMPROW line = row.data();
    jpeg_write_scanlines(&codec, &line, 1);
  }
  jpeg_finish_compress(&codec);
  std::string file(reinterpret_cast<const char*>(buffer), size);
  jpeg_destroy_compress(&codec);
  std::free(buffer);
  return file;
}

std::string luminance_chroma_exr(const std::string& path, int width, int height) {
  {
    std::vector<Imf::Rgba> pixels;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const float grey = float(x) / float(width);
        pixels.emplace_back(grey, grey, grey);
      }
    Imf::RgbaOutputFile file(path.c_str(), width, height, Imf::WRITE_YC);
    file.setFrameBuffer(pixels.data(), 1, size_t(width));
    file.writePixels(height);
  }
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string png_of(int width, int height, int bits, int colour_type, bool is_interlaced,
                   const std::vector<std::string>& rows) {
  std::string file;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &file,
      [](png_structp writer, png_bytep bytes, size_t size) {
        static_cast<std::string*>(png_get_io_ptr(writer))
            ->append(reinterpret_cast<const char*>(bytes), size);
      },
      nullptr);
  png_set_IHDR(png, info, uint32_t(width), uint32_t(height), bits, colour_type,
               is_interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  std::vector<png_bytep> lines;
  for (const std::string& row : rows)
    lines.push_back(reinterpret_cast<png_bytep>(const_cast<char*>(row.data())));
  png_write_image(png, lines.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return file;
}

std::string png_chunk(const std::string& type, const std::string& data) {
  const auto big_endian = [](uint32_t v) {
    return std::string{char(v >> 24), char(v >> 16), char(v >> 8), char(v)};
  };
  uint32_t crc = 0xffffffff;
  for (const char c : type + data) {
    crc ^= uint8_t(c);
    for (int bit = 0; bit < 8; ++bit) crc = crc & 1 ? crc >> 1 ^ 0xedb88320 : crc >> 1;
  }
  return big_endian(uint32_t(data.size())) + type + data + big_endian(~crc);
}

}  // namespace kaustik::testing
