#pragma once
// Files of formats that Kaustik reads and does not write, byte by byte or by their libraries.

#include <cstdint>
#include <string>
#include <vector>

namespace kaustik::testing {

/// Little-endian numbers.
std::string u16(int value);
std::string u32(uint32_t value);

/// File and info header of a BMP with `palette` (blue, green, red, 0 per entry) or masks after it.
std::string bmp(int width, int height, int bits, int compression, const std::string& palette,
                const std::string& pixels);
/// 8 × 4, 8 bits, run-length encoded, with every escape.
std::string bmp_with_runs();
/// 2 × 2, 32 bits, with a mask for opacity.
std::string bmp_with_masks();

/// Header of a TGA without colours of a map, and its pixels.
std::string tga(int type, int width, int height, int depth, int flags, const std::string& pixels);
/// 4 × 3, 24 bits.
std::string tga_with_runs();

/// Lossless; pixel (x, y) is (10 x, 10 y, 200) of 255.
std::string webp_picture(int width, int height);

/// All pixels have 20 % cyan, no magenta, 60 % yellow and 50 % black.
std::string cmyk_jpeg(int width, int height, bool by_adobe);

/// A grey ramp from 0 to 1 with chroma of half resolution; `path` is for the file on its way.
std::string luminance_chroma_exr(const std::string& path, int width, int height);

/// `rows`: the bytes of each line, as PNG stores them; `colour_type` is libpng's.
std::string png_of(int width, int height, int bits, int colour_type, bool is_interlaced,
                   const std::vector<std::string>& rows);
/// A PNG chunk with its checksum.
std::string png_chunk(const std::string& type, const std::string& data);

}  // namespace kaustik::testing
