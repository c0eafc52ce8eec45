#include <limits>

#include "kaustik/image/photometry.h"
#include "kaustik/image/tiff_memory.h"
#include "kaustik/image/tone_mapping.h"

namespace kaustik::formats {
namespace {

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
  MemoryTiff file;
  file.is_writing = true;
  TiffPointer tiff = open_tiff(file, "w", std::numeric_limits<tmsize_t>::max());
  set_common_tags(tiff.get(), image);
  set_tags(tiff.get());
  for (size_t y = 0; y < size_t(image.height()); ++y)
    if (TIFFWriteScanline(tiff.get(), line_at(y), uint32_t(y), 0) < 0) fail(file);
  if (!TIFFFlush(tiff.get())) fail(file);
  tiff.reset();
  if (!file.error.empty()) fail(file);
  return std::move(file.written);
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

}  // namespace kaustik::formats
