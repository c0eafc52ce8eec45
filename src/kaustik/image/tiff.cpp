// TIFF through libtiff: LogLuv (Ward Larson, "LogLuv Encoding for Full-Gamut, High-Dynamic Range
// Images", JGT 1998) and plain integer and float pictures.

#include <cmath>
#include <cstring>
#include <limits>

#include "kaustik/image/photometry.h"
#include "kaustik/image/tiff_memory.h"

namespace kaustik::formats {
namespace {

struct Layout {
  uint32_t width = 0, height = 0;
  uint16_t channels = 1, bits = 1, sample_format = SAMPLEFORMAT_UINT;
  uint16_t photometric = 0, planar = PLANARCONFIG_CONTIG;
  bool is_log = false;

  int decoded_channels() const { return photometric == PHOTOMETRIC_LOGL ? 1 : int(channels); }
  size_t sample_bytes() const { return is_log ? sizeof(float) : bits / 8u; }
};

/// The size and kind of the picture; for LogLuv also asks libtiff for floats.
Layout read_layout(TIFF* tiff, size_t file_size, const ReadOptions& options) {
  Layout layout;
  TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &layout.width);
  TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &layout.height);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &layout.channels);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &layout.bits);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &layout.sample_format);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_PLANARCONFIG, &layout.planar);
  TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &layout.photometric);
  layout.is_log =
      layout.photometric == PHOTOMETRIC_LOGLUV || layout.photometric == PHOTOMETRIC_LOGL;
  if (layout.is_log) {
    TIFFSetField(tiff, TIFFTAG_SGILOGDATAFMT, SGILOGDATAFMT_FLOAT);
    layout.channels = layout.photometric == PHOTOMETRIC_LOGLUV ? 3 : 1;
  }
  const bool is_supported =
      layout.is_log ||
      (layout.sample_format == SAMPLEFORMAT_UINT && (layout.bits == 8 || layout.bits == 16)) ||
      (layout.sample_format == SAMPLEFORMAT_IEEEFP && layout.bits == 32);
  const bool has_colours = layout.is_log || layout.photometric == PHOTOMETRIC_RGB ||
                           layout.photometric == PHOTOMETRIC_MINISBLACK;
  if (!is_supported || !has_colours || layout.channels > 4 ||
      (layout.planar != PLANARCONFIG_CONTIG && layout.channels > 1))
    throw BadImage(
        "this kind of TIFF is not supported (LogLuv, or grey or RGB with 8 or 16 bit integers or "
        "32 bit floats is)");
  constexpr double most_pixels_per_byte = 40000;  // a run in Zstandard: 128 KB in 4 bytes
  // The library decodes LogLuv by strips.
  const int64_t work_bytes = layout.is_log ? 4 : 0;
  check_promise({layout.width, layout.height, layout.channels, work_bytes, most_pixels_per_byte},
                file_size, options);
  return layout;
}

float sample_at(const uint8_t* bytes, size_t index, const Layout& layout) {
  if (layout.sample_bytes() == 1) return float(bytes[index]) / 255;
  if (layout.sample_bytes() == 2) {
    uint16_t value;
    std::memcpy(&value, bytes + 2 * index, sizeof(value));
    return float(value) / 65535;
  }
  float value;
  std::memcpy(&value, bytes + 4 * index, sizeof(value));
  return value;
}

void copy_row(const uint8_t* bytes, const Layout& layout, int x0, int y, int count, Image& image) {
  for (int x = 0; x < count && x0 + x < image.width(); ++x)
    for (int c = 0; c < image.channel_count(); ++c)
      image.at(x0 + x, y, c) = sample_at(bytes, size_t(x) * layout.channels + size_t(c), layout);
}

void read_tiles(TIFF* tiff, const MemoryTiff& file, const Layout& layout,
                const ReadOptions& options, Image& image) {
  uint32_t tile_width = 0, tile_height = 0;
  TIFFGetField(tiff, TIFFTAG_TILEWIDTH, &tile_width);
  TIFFGetField(tiff, TIFFTAG_TILELENGTH, &tile_height);
  check_promise({tile_width, tile_height, 0, int64_t(2 * layout.channels * layout.sample_bytes()),
                 std::numeric_limits<double>::infinity()},
                0, options);
  const size_t row_bytes = size_t(tile_width) * layout.channels * layout.sample_bytes();
  const tmsize_t tile_bytes = TIFFTileSize(tiff);
  if (tile_bytes <= 0 || size_t(tile_bytes) < row_bytes * tile_height) fail(file);
  WorkBytes tile(static_cast<size_t>(tile_bytes));
  for (int64_t y0 = 0; y0 < image.height(); y0 += tile_height)
    for (int64_t x0 = 0; x0 < image.width(); x0 += tile_width) {
      if (TIFFReadTile(tiff, tile.data(), uint32_t(x0), uint32_t(y0), 0, 0) < 0) fail(file);
      for (int64_t y = 0; y < tile_height && y0 + y < image.height(); ++y)
        copy_row(tile.data() + size_t(y) * row_bytes, layout, int(x0), int(y0 + y), int(tile_width),
                 image);
    }
}

void read_lines(TIFF* tiff, const MemoryTiff& file, const Layout& layout, Image& image) {
  const size_t row_bytes = size_t(layout.width) * layout.channels * layout.sample_bytes();
  const tmsize_t line_bytes = TIFFScanlineSize(tiff);
  if (line_bytes <= 0 || size_t(line_bytes) < row_bytes) fail(file);
  WorkBytes line(static_cast<size_t>(line_bytes));
  for (int y = 0; y < image.height(); ++y) {
    if (TIFFReadScanline(tiff, line.data(), uint32_t(y), 0) < 0) fail(file);
    copy_row(line.data(), layout, 0, y, image.width(), image);
  }
}

/// From CIE XYZ in the file's unit to radiance, absolute if the file says how bright a unit is.
void radiance_from_log(TIFF* tiff, Image& image) {
  double candelas = 0;
  if (!TIFFGetField(tiff, TIFFTAG_STONITS, &candelas) || !(candelas > 0) ||
      !std::isfinite(candelas))
    candelas = double(white_efficacy);
  const float scale = float(candelas / double(white_efficacy));
  for (size_t i = 0; i < image.pixel_count(); ++i) {
    if (image.channel_count() == 1) {
      image.channel(0)[i] *= scale;
      continue;
    }
    const Vec3f xyz(image.channel(0)[i], image.channel(1)[i], image.channel(2)[i]);
    const Vec3f rgb = rgb_from_xyz(xyz) * scale;
    for (int c = 0; c < 3; ++c) image.channel(c)[i] = rgb[c];
  }
}

}  // namespace

Image decode_tiff(ByteView bytes, const ReadOptions& options) {
  MemoryTiff file;
  file.readable = bytes;
  // "m": no memory mapping, the data is in memory already.
  const TiffPointer tiff = open_tiff(file, "rm", options.memory_bytes);
  const Layout layout = read_layout(tiff.get(), bytes.size(), options);
  Image image(int(layout.width), int(layout.height), channel_names_for(layout.channels));
  if (TIFFIsTiled(tiff.get()))
    read_tiles(tiff.get(), file, layout, options, image);
  else
    read_lines(tiff.get(), file, layout, image);
  if (!file.error.empty()) fail(file);
  if (layout.is_log) radiance_from_log(tiff.get(), image);
  image.set_srgb_encoded(!layout.is_log && layout.sample_bytes() < 4);
  const char* description = nullptr;
  if (TIFFGetField(tiff.get(), TIFFTAG_IMAGEDESCRIPTION, &description) && description)
    set_metadata_from_lines(image, description);
  return image;
}

}  // namespace kaustik::formats
