#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <new>
// jpeglib.h needs the standard headers above it.
#include <jerror.h>
#include <jpeglib.h>

#include "kaustik/image/formats.h"
#include "kaustik/image/tone_mapping.h"

// As with libpng, errors come by longjmp(): functions that call setjmp() own plain values only.

namespace kaustik::formats {
namespace {

struct ErrorManager {
  jpeg_error_mgr base;  // first, since the library only knows this part
  std::jmp_buf jump;
  char error[JMSG_LENGTH_MAX] = "";
  bool lacks_memory = false;
};

ErrorManager& manager_of(j_common_ptr codec) {
  return *reinterpret_cast<ErrorManager*>(codec->err);
}

void stop(j_common_ptr codec) {
  manager_of(codec).lacks_memory =
      codec->err->msg_code == JERR_OUT_OF_MEMORY || codec->err->msg_code == JERR_NO_BACKING_STORE;
  codec->err->format_message(codec, manager_of(codec).error);
  std::longjmp(manager_of(codec).jump, 1);
}

/// Warnings mean that pixels were made up for what is missing or corrupt; only stray bytes between
/// markers do no harm.
void stop_at_warnings(j_common_ptr codec, int level) {
  if (level < 0 && codec->err->msg_code != JWRN_EXTRANEOUS_DATA) stop(codec);
}

void install(ErrorManager& manager) {
  jpeg_std_error(&manager.base);
  manager.base.error_exit = stop;
  manager.base.emit_message = stop_at_warnings;
}

/// Each scan of a progressive picture goes over all of its pixels, and may take no more than a few
/// bytes. Real ones have about ten.
void limit_scans(j_common_ptr codec) {
  constexpr int most_scans = 100;
  constexpr double most_scanned_pixels = 5e9;
  auto* const reader = reinterpret_cast<j_decompress_ptr>(codec);
  const double pixels = double(reader->image_width) * double(reader->image_height);
  if (reader->input_scan_number <= most_scans &&
      (reader->input_scan_number <= 1 || reader->input_scan_number * pixels <= most_scanned_pixels))
    return;
  std::snprintf(manager_of(codec).error, JMSG_LENGTH_MAX, "it has too many scans");
  std::longjmp(manager_of(codec).jump, 1);
}

/// A decompressor, destroyed with this.
struct Decompressor {
  Decompressor() {
    install(errors);
    codec.err = &errors.base;
  }
  ~Decompressor() { jpeg_destroy_decompress(&codec); }
  Decompressor(const Decompressor&) = delete;
  Decompressor& operator=(const Decompressor&) = delete;

  jpeg_decompress_struct codec = {};
  jpeg_progress_mgr progress = {};
  ErrorManager errors;
};

struct Compressor {
  Compressor() {
    install(errors);
    codec.err = &errors.base;
  }
  ~Compressor() {
    jpeg_destroy_compress(&codec);
    std::free(buffer);
  }
  Compressor(const Compressor&) = delete;
  Compressor& operator=(const Compressor&) = delete;

  jpeg_compress_struct codec = {};
  ErrorManager errors;
  unsigned char* buffer = nullptr;
  unsigned long size = 0;
};

bool read_header(Decompressor& reader, const uint8_t* data, size_t size) {
  if (setjmp(reader.errors.jump)) return false;
  jpeg_create_decompress(&reader.codec);
  jpeg_mem_src(&reader.codec, data, static_cast<unsigned long>(size));
  jpeg_read_header(&reader.codec, TRUE);
  return true;
}

/// Asks for grey, RGB or CMYK; false if the library cannot make that of it.
bool start_reading(Decompressor& reader) {
  if (setjmp(reader.errors.jump)) return false;
  const J_COLOR_SPACE stored = reader.codec.jpeg_color_space;
  const bool is_print = stored == JCS_CMYK || stored == JCS_YCCK;
  reader.codec.out_color_space = stored == JCS_GRAYSCALE ? JCS_GRAYSCALE
                                 : is_print              ? JCS_CMYK
                                                         : JCS_RGB;
  // The same pixels everywhere, whatever the library thinks fastest.
  reader.codec.dct_method = JDCT_ISLOW;
  reader.progress.progress_monitor = limit_scans;
  reader.codec.progress = &reader.progress;
  jpeg_start_decompress(&reader.codec);
  return true;
}

bool read_row(Decompressor& reader, uint8_t* row) {
  if (setjmp(reader.errors.jump)) return false;
  jpeg_read_scanlines(&reader.codec, &row, 1);
  return true;
}

bool finish_reading(Decompressor& reader) {
  if (setjmp(reader.errors.jump)) return false;
  jpeg_finish_decompress(&reader.codec);
  return true;
}

[[noreturn]] void fail(const ErrorManager& errors) {
  if (errors.lacks_memory) throw std::bad_alloc();
  throw BadImage(errors.error);
}

/// Red, green and blue of cyan, magenta, yellow and black, without profiles: what ink leaves of
/// white. Adobe stores what is left of the paper, others the ink.
void rgb_from_cmyk(uint8_t* row, size_t width, bool is_inverted) {
  for (size_t x = 0; x < width; ++x) {
    int left[4];
    for (size_t c = 0; c < 4; ++c) left[c] = is_inverted ? row[4 * x + c] : 255 - row[4 * x + c];
    for (size_t c = 0; c < 3; ++c) row[3 * x + c] = uint8_t((left[c] * left[3] + 127) / 255);
  }
}

bool write_all(Compressor& writer, uint32_t width, uint32_t height, int quality, uint8_t* pixels) {
  if (setjmp(writer.errors.jump)) return false;
  jpeg_compress_struct* const codec = &writer.codec;
  jpeg_create_compress(codec);
  jpeg_mem_dest(codec, &writer.buffer, &writer.size);
  codec->image_width = width;
  codec->image_height = height;
  codec->input_components = 3;
  codec->in_color_space = JCS_RGB;
  jpeg_set_defaults(codec);
  jpeg_set_quality(codec, quality, TRUE);
  // Colours at full resolution: rendered edges are sharper than photographed ones.
  codec->comp_info[0].h_samp_factor = codec->comp_info[0].v_samp_factor = 1;
  codec->dct_method = JDCT_ISLOW;
  jpeg_start_compress(codec, TRUE);
  while (codec->next_scanline < codec->image_height) {
    JSAMPROW row = pixels + size_t(codec->next_scanline) * width * 3;
    jpeg_write_scanlines(codec, &row, 1);
  }
  jpeg_finish_compress(codec);
  return true;
}

}  // namespace

Bytes encode_jpeg(const Image& display_linear, int quality) {
  if (display_linear.width() > JPEG_MAX_DIMENSION || display_linear.height() > JPEG_MAX_DIMENSION)
    throw BadImage("a JPEG has at most 65500 pixels along a side");
  if (quality < 1 || quality > 100) throw BadImage("the JPEG quality must be 1 to 100");
  Bytes pixels = srgb_bytes(display_linear);
  Compressor writer;
  if (!write_all(writer, uint32_t(display_linear.width()), uint32_t(display_linear.height()),
                 quality, pixels.data())) {
    // The library may have moved the buffer and tells of it only at the end. Memory that is lost is
    // better than memory that is freed twice.
    writer.buffer = nullptr;
    fail(writer.errors);
  }
  return Bytes(writer.buffer, writer.buffer + writer.size);
}

Image decode_jpeg(ByteView file, const ReadOptions& options) {
  Decompressor reader;
  if (!read_header(reader, file.data(), file.size())) fail(reader.errors);
  const int64_t width = reader.codec.image_width, height = reader.codec.image_height;
  const int stored_channels = reader.codec.num_components;
  const int channels = stored_channels == 1 ? 1 : 3;
  constexpr double most_pixels_per_byte = 512;  // one bit per block of 8 × 8
  // With several scans the library keeps the coefficients of all blocks.
  const bool has_scans = jpeg_has_multiple_scans(&reader.codec) != FALSE;
  const int64_t work_bytes = has_scans ? stored_channels * int64_t(sizeof(JCOEF)) : 0;
  check_promise({width, height, channels, work_bytes, most_pixels_per_byte}, file.size(), options);
  if (!start_reading(reader)) fail(reader.errors);
  const bool is_print = reader.codec.out_color_space == JCS_CMYK;
  std::vector<uint8_t> row(size_t(width) * size_t(reader.codec.output_components));
  Image image(int(width), int(height), channel_names_for(channels));
  for (int y = 0; y < image.height(); ++y) {
    if (!read_row(reader, row.data())) fail(reader.errors);
    if (is_print) rgb_from_cmyk(row.data(), size_t(width), reader.codec.saw_Adobe_marker != FALSE);
    for (int x = 0; x < image.width(); ++x)
      set_pixel(image, x, y, row.data() + size_t(x) * size_t(channels));
  }
  if (!finish_reading(reader)) fail(reader.errors);
  image.set_srgb_encoded(true);
  return image;
}

}  // namespace kaustik::formats
