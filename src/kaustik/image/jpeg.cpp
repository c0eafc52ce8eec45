#include <csetjmp>
#include <cstdio>
#include <cstdlib>
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
};

ErrorManager& manager_of(j_common_ptr codec) {
  return *reinterpret_cast<ErrorManager*>(codec->err);
}

void stop(j_common_ptr codec) {
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

/// Asks for grey or RGB; false if the library cannot make that of it.
bool start_reading(Decompressor& reader) {
  if (setjmp(reader.errors.jump)) return false;
  const bool is_grey = reader.codec.jpeg_color_space == JCS_GRAYSCALE;
  reader.codec.out_color_space = is_grey ? JCS_GRAYSCALE : JCS_RGB;
  // The same pixels everywhere, whatever the library thinks fastest.
  reader.codec.dct_method = JDCT_ISLOW;
  jpeg_start_decompress(&reader.codec);
  return true;
}

bool read_rows(Decompressor& reader, uint8_t* pixels, size_t row_bytes) {
  if (setjmp(reader.errors.jump)) return false;
  while (reader.codec.output_scanline < reader.codec.output_height) {
    JSAMPROW row = pixels + size_t(reader.codec.output_scanline) * row_bytes;
    jpeg_read_scanlines(&reader.codec, &row, 1);
  }
  jpeg_finish_decompress(&reader.codec);
  return true;
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
    // The library may have moved the buffer and tells of it only at the end: better leaked, out of
    // memory as we must be, than freed twice.
    writer.buffer = nullptr;
    throw BadImage(writer.errors.error);
  }
  return Bytes(writer.buffer, writer.buffer + writer.size);
}

Image decode_jpeg(ByteView file) {
  Decompressor reader;
  if (!read_header(reader, file.data(), file.size())) throw BadImage(reader.errors.error);
  const int64_t width = reader.codec.image_width, height = reader.codec.image_height;
  constexpr double most_pixels_per_byte = 512;  // one bit per block of 8 × 8
  check_header_size(width, height, 3, file.size(), most_pixels_per_byte);
  if (!start_reading(reader)) throw BadImage(reader.errors.error);
  const int channels = reader.codec.output_components;
  const size_t row_bytes = size_t(width) * size_t(channels);
  Bytes pixels(row_bytes * size_t(height));
  if (!read_rows(reader, pixels.data(), row_bytes)) throw BadImage(reader.errors.error);
  Image image(int(width), int(height), channel_names_for(channels));
  for (size_t i = 0; i < image.pixel_count(); ++i)
    for (int c = 0; c < channels; ++c)
      image.channel(c)[i] = float(pixels[i * size_t(channels) + size_t(c)]) / 255;
  image.set_srgb_encoded(true);
  return image;
}

}  // namespace kaustik::formats
