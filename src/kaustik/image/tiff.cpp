// TIFF through libtiff: LogLuv (Ward Larson, "LogLuv Encoding for Full-Gamut, High-Dynamic Range
// Images", JGT 1998) written and read, 8-bit sRGB written, plain integer
// and float pictures read.

#include <fmt/format.h>
#include <tiffio.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <memory>

#include "kaustik/image/formats.h"
#include "kaustik/image/photometry.h"
#include "kaustik/image/tone_mapping.h"

namespace kaustik::formats {
namespace {

/// The file in memory, as libtiff's client functions see it.
struct MemoryFile {
  Bytes written;
  ByteView readable;
  size_t position = 0;
  bool is_writing = false;
  std::string error;  ///< the first that libtiff reported

  ByteView contents() const { return is_writing ? ByteView(written) : readable; }
};

MemoryFile& file_of(thandle_t handle) { return *static_cast<MemoryFile*>(handle); }

tmsize_t read_some(thandle_t handle, void* buffer, tmsize_t size) {
  MemoryFile& file = file_of(handle);
  const ByteView contents = file.contents();
  if (file.position >= contents.size() || size <= 0) return 0;
  const size_t count = std::min(size_t(size), contents.size() - file.position);
  std::memcpy(buffer, contents.data() + file.position, count);
  file.position += count;
  return tmsize_t(count);
}

tmsize_t write_some(thandle_t handle, void* buffer, tmsize_t size) {
  MemoryFile& file = file_of(handle);
  if (!file.is_writing || size < 0) return -1;
  const size_t end = file.position + size_t(size);
  if (end > file.written.size()) file.written.resize(end);
  std::memcpy(file.written.data() + file.position, buffer, size_t(size));
  file.position = end;
  return size;
}

toff_t seek_to(thandle_t handle, toff_t offset, int origin) {
  MemoryFile& file = file_of(handle);
  if (origin == SEEK_SET) file.position = size_t(offset);
  if (origin == SEEK_CUR) file.position += size_t(offset);
  if (origin == SEEK_END) file.position = file.contents().size() + size_t(offset);
  return toff_t(file.position);
}

int close_nothing(thandle_t) { return 0; }
toff_t size_of(thandle_t handle) { return toff_t(file_of(handle).contents().size()); }

int keep_error(TIFF*, void* user_data, const char*, const char* format, va_list arguments) {
  char text[512];
  std::vsnprintf(text, sizeof(text), format, arguments);
  auto& file = *static_cast<MemoryFile*>(user_data);
  if (file.error.empty()) file.error = text;
  return 1;  // do not call the global handler, which prints
}
/// Drops it, unless the file ends before the value of a tag: without it the unit or the field of
/// view would be wrong.
int drop_warning(TIFF* tiff, void* user_data, const char* module, const char* format,
                 va_list arguments) {
  if (std::string_view(format).starts_with("IO error"))
    return keep_error(tiff, user_data, module, format, arguments);
  return 1;
}

struct CloseTiff {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};
using TiffPointer = std::unique_ptr<TIFF, CloseTiff>;

[[noreturn]] void fail(const MemoryFile& file) {
  throw BadImage(file.error.empty() ? "its TIFF structure is broken" : file.error);
}

TiffPointer open(MemoryFile& file, const char* mode) {
  const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> options(TIFFOpenOptionsAlloc(),
                                                                             TIFFOpenOptionsFree);
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_error, &file);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), drop_warning, &file);
  // What a corrupt directory may ask for at once.
  if (!file.is_writing) TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), tmsize_t{1} << 30);
  TiffPointer tiff(TIFFClientOpenExt("memory", mode, &file, read_some, write_some, seek_to,
                                     close_nothing, size_of, nullptr, nullptr, options.get()));
  if (!tiff) fail(file);
  return tiff;
}

void set_common_tags(TIFF* tiff, const Image& image) {
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, uint32_t(image.width()));
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, uint32_t(image.height()));
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 3);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(tiff, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
  TIFFSetField(tiff, TIFFTAG_SOFTWARE, "Kaustik");
  const std::string lines = metadata_lines(image);
  if (!lines.empty()) TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, lines.c_str());
}

void set_logluv_tags(TIFF* tiff) {
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_SGILOG);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_LOGLUV);
  TIFFSetField(tiff, TIFFTAG_SGILOGDATAFMT, SGILOGDATAFMT_FLOAT);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 32);
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, TIFFDefaultStripSize(tiff, 0));
  // Y is photopic radiance in W/(sr·m²); this factor makes it cd/m².
  TIFFSetField(tiff, TIFFTAG_STONITS, double(white_efficacy));
}

void set_srgb_tags(TIFF* tiff) {
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_LZW);
  TIFFSetField(tiff, TIFFTAG_PREDICTOR, PREDICTOR_HORIZONTAL);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 8);
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, TIFFDefaultStripSize(tiff, 0));
}

/// The bytes of a file whose lines `line_at(y)` returns a pointer to.
template <typename LineAt>
Bytes encode(const Image& image, void (*set_tags)(TIFF*), const LineAt& line_at) {
  MemoryFile file;
  file.is_writing = true;
  TiffPointer tiff = open(file, "w");
  set_common_tags(tiff.get(), image);
  set_tags(tiff.get());
  for (size_t y = 0; y < size_t(image.height()); ++y)
    if (TIFFWriteScanline(tiff.get(), line_at(y), uint32_t(y), 0) < 0) fail(file);
  if (!TIFFFlush(tiff.get())) fail(file);
  tiff.reset();
  if (!file.error.empty()) fail(file);
  return std::move(file.written);
}

struct Layout {
  uint32_t width = 0, height = 0;
  uint16_t channels = 1, bits = 1, sample_format = SAMPLEFORMAT_UINT;
  uint16_t photometric = 0, planar = PLANARCONFIG_CONTIG;
  bool is_log = false;

  int decoded_channels() const { return photometric == PHOTOMETRIC_LOGL ? 1 : int(channels); }
  size_t sample_bytes() const { return is_log ? sizeof(float) : bits / 8u; }
};

/// The size and kind of the picture; for LogLuv also asks libtiff for floats.
Layout read_layout(TIFF* tiff, size_t file_size) {
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
  constexpr double most_pixels_per_byte = 8200;  // long runs in LZMA or deflated zeros
  check_header_size(layout.width, layout.height, layout.channels, file_size, most_pixels_per_byte);
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

void read_tiles(TIFF* tiff, const MemoryFile& file, const Layout& layout, Image& image) {
  uint32_t tile_width = 0, tile_height = 0;
  TIFFGetField(tiff, TIFFTAG_TILEWIDTH, &tile_width);
  TIFFGetField(tiff, TIFFTAG_TILELENGTH, &tile_height);
  check_image_size(tile_width, tile_height, layout.channels);
  const size_t row_bytes = size_t(tile_width) * layout.channels * layout.sample_bytes();
  const tmsize_t tile_bytes = TIFFTileSize(tiff);
  if (tile_bytes <= 0 || size_t(tile_bytes) < row_bytes * tile_height) fail(file);
  Bytes tile(static_cast<size_t>(tile_bytes));
  for (int64_t y0 = 0; y0 < image.height(); y0 += tile_height)
    for (int64_t x0 = 0; x0 < image.width(); x0 += tile_width) {
      if (TIFFReadTile(tiff, tile.data(), uint32_t(x0), uint32_t(y0), 0, 0) < 0) fail(file);
      for (int64_t y = 0; y < tile_height && y0 + y < image.height(); ++y)
        copy_row(tile.data() + size_t(y) * row_bytes, layout, int(x0), int(y0 + y), int(tile_width),
                 image);
    }
}

void read_lines(TIFF* tiff, const MemoryFile& file, const Layout& layout, Image& image) {
  const size_t row_bytes = size_t(layout.width) * layout.channels * layout.sample_bytes();
  const tmsize_t line_bytes = TIFFScanlineSize(tiff);
  if (line_bytes <= 0 || size_t(line_bytes) < row_bytes) fail(file);
  Bytes line(static_cast<size_t>(line_bytes));
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

Bytes encode_logluv_tiff(const Image& image, const std::string& layer) {
  const RgbView rgb = rgb_view(image, layer);
  const size_t width = size_t(image.width());
  std::vector<float> line(3 * width);
  return encode(image, set_logluv_tags, [&](size_t y) {
    for (size_t x = 0; x < width; ++x) {
      const Vec3f colour = rgb[y * width + x];
      const Vec3f xyz = is_finite(colour) ? xyz_from_rgb(colour) : Vec3f(0);
      for (int c = 0; c < 3; ++c) line[3 * x + size_t(c)] = xyz[c];
    }
    return line.data();
  });
}

Bytes encode_srgb_tiff(const Image& display_linear) {
  std::vector<uint8_t> bytes = srgb_bytes(display_linear);
  const size_t line_bytes = 3 * size_t(display_linear.width());
  return encode(display_linear, set_srgb_tags,
                [&](size_t y) { return bytes.data() + y * line_bytes; });
}

Image decode_tiff(ByteView bytes) {
  MemoryFile file;
  file.readable = bytes;
  // "m": no memory mapping, the data is in memory already.
  const TiffPointer tiff = open(file, "rm");
  const Layout layout = read_layout(tiff.get(), bytes.size());
  Image image(int(layout.width), int(layout.height), channel_names_for(layout.channels));
  if (TIFFIsTiled(tiff.get()))
    read_tiles(tiff.get(), file, layout, image);
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
