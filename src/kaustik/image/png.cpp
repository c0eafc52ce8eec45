#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <new>

#include "kaustik/image/formats.h"
#include "kaustik/image/tone_mapping.h"

// libpng reports errors by longjmp(), which must not pass the destructor of anything. So every
// function that calls setjmp() here owns nothing but plain values; what needs a destructor lives in
// its caller.

namespace kaustik::formats {
namespace {

/// What both directions share with libpng's callbacks.
struct State {
  ByteView readable;
  Bytes written;
  char error[256] = "";
};

void keep_error(png_structp png, png_const_charp text) {
  auto* state = static_cast<State*>(png_get_error_ptr(png));
  std::snprintf(state->error, sizeof(state->error), "%s", text);
  png_longjmp(png, 1);
}
void drop_warning(png_structp, png_const_charp) {}

void read_some(png_structp png, png_bytep target, size_t size) {
  auto* state = static_cast<State*>(png_get_io_ptr(png));
  if (size > state->readable.size()) png_error(png, "the file is truncated");
  std::memcpy(target, state->readable.data(), size);
  state->readable = state->readable.subspan(size);
}

bool append_all(State& state, const uint8_t* data, size_t size) {
  try {
    state.written.insert(state.written.end(), data, data + size);
    return true;
  } catch (const std::bad_alloc&) {
    return false;
  }
}
void write_some(png_structp png, png_bytep data, size_t size) {
  if (!append_all(*static_cast<State*>(png_get_io_ptr(png)), data, size))
    png_error(png, "out of memory");
}
void flush_nothing(png_structp) {}

/// A reader or writer of libpng, destroyed with this.
class Png {
 public:
  Png(State& state, bool is_reader) : is_reader_(is_reader) {
    png_ = is_reader
               ? png_create_read_struct(PNG_LIBPNG_VER_STRING, &state, keep_error, drop_warning)
               : png_create_write_struct(PNG_LIBPNG_VER_STRING, &state, keep_error, drop_warning);
    info_ = png_ ? png_create_info_struct(png_) : nullptr;
    if (!info_) {
      destroy();
      throw std::bad_alloc();
    }
    if (is_reader)
      png_set_read_fn(png_, &state, read_some);
    else
      png_set_write_fn(png_, &state, write_some, flush_nothing);
  }
  ~Png() { destroy(); }
  Png(const Png&) = delete;
  Png& operator=(const Png&) = delete;
  png_structp get() const { return png_; }
  png_infop info() const { return info_; }

 private:
  void destroy() {
    if (is_reader_)
      png_destroy_read_struct(&png_, &info_, nullptr);
    else
      png_destroy_write_struct(&png_, &info_);
  }
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  bool is_reader_;
};

/// Reads all before the pixels and asks for 8 or 16 bit samples without palettes.
bool read_header(png_structp png, png_infop info) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_user_limits(png, INT32_MAX, INT32_MAX);  // checked by check_header_size()
  png_read_info(png, info);
  png_set_expand(png);  // palettes, 1 to 4 bits, transparent colours
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  return true;
}

bool read_rows(png_structp png, png_infop info, uint8_t** rows) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_read_image(png, rows);
  png_read_end(png, info);
  return true;
}

bool write_all(png_structp png, png_infop info, uint32_t width, uint32_t height, uint8_t** rows,
               const png_text* texts, int text_count) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_user_limits(png, INT32_MAX, INT32_MAX);
  png_set_IHDR(png, info, width, height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_RELATIVE);
  if (text_count > 0) png_set_text(png, info, texts, text_count);
  png_write_info(png, info);
  png_write_image(png, rows);
  png_write_end(png, info);
  return true;
}

/// Every chunk up to the end mark lies within the file: libpng allocates a chunk's length before it
/// reads, so a corrupt one would cost gigabytes.
void check_chunks(ByteView file) {
  constexpr size_t signature = 8, around_data = 12;  // length, type and checksum
  for (size_t position = signature;;) {
    if (position > file.size() || file.size() - position < around_data)
      throw BadImage("the file is truncated");
    const uint8_t* chunk = file.data() + position;
    const size_t length =
        size_t(chunk[0]) << 24 | size_t(chunk[1]) << 16 | size_t(chunk[2]) << 8 | size_t(chunk[3]);
    if (length > file.size() - position - around_data)
      throw BadImage("the file is truncated, or the length of a chunk is corrupt");
    if (std::memcmp(chunk + 4, "IEND", 4) == 0) return;
    position += length + around_data;
  }
}

/// sRGB unless the file states that its samples are linear.
bool is_srgb(png_structp png, png_infop info) {
  int intent = 0;
  double gamma = 0;
  if (png_get_sRGB(png, info, &intent)) return true;
  return !png_get_gAMA(png, info, &gamma) || std::fabs(gamma - 1) > 0.01;
}

std::vector<uint8_t*> row_pointers(Bytes& pixels, size_t row_bytes) {
  std::vector<uint8_t*> rows;
  for (size_t offset = 0; offset < pixels.size(); offset += row_bytes)
    rows.push_back(pixels.data() + offset);
  return rows;
}

void copy_pixels(const Bytes& pixels, int bits, Image& image) {
  const size_t channels = size_t(image.channel_count());
  for (size_t i = 0; i < image.pixel_count(); ++i)
    for (size_t c = 0; c < channels; ++c) {
      const size_t sample = i * channels + c;
      const int value =
          bits == 16 ? pixels[2 * sample] << 8 | pixels[2 * sample + 1] : int(pixels[sample]);
      image.channel(int(c))[i] = float(value) / (bits == 16 ? 65535.0f : 255.0f);
    }
}

void read_texts(png_structp png, png_infop info, Image& image) {
  png_textp texts = nullptr;
  const int count = png_get_text(png, info, &texts, nullptr);
  for (int i = 0; i < count; ++i)
    if (texts[i].key && texts[i].text) image.set_metadata(texts[i].key, std::string(texts[i].text));
}

/// PNG keywords have 1 to 79 characters; longer keys are shortened.
struct Texts {
  std::vector<std::string> keys, values;
  std::vector<png_text> entries;

  explicit Texts(const Image& image) {
    constexpr size_t longest_key = 79;
    for (const auto& [key, value] : image.metadata()) {
      if (key.empty()) continue;
      keys.push_back(key.substr(0, longest_key));
      values.push_back(text_of(value));
    }
    for (size_t i = 0; i < keys.size(); ++i) {
      png_text entry = {};
      // tEXt is Latin-1, iTXt is UTF-8.
      const bool is_ascii = std::all_of(values[i].begin(), values[i].end(),
                                        [](char c) { return static_cast<unsigned char>(c) < 128; });
      entry.compression = is_ascii ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
      entry.key = keys[i].data();
      entry.text = values[i].data();
      (is_ascii ? entry.text_length : entry.itxt_length) = values[i].size();
      entries.push_back(entry);
    }
  }
};

}  // namespace

Bytes encode_png(const Image& display_linear) {
  State state;
  Bytes pixels = srgb_bytes(display_linear);
  std::vector<uint8_t*> rows = row_pointers(pixels, 3 * size_t(display_linear.width()));
  const Texts texts(display_linear);
  const Png png(state, false);
  if (!write_all(png.get(), png.info(), uint32_t(display_linear.width()),
                 uint32_t(display_linear.height()), rows.data(), texts.entries.data(),
                 int(texts.entries.size())))
    throw BadImage(state.error);
  return std::move(state.written);
}

Image decode_png(ByteView file) {
  check_chunks(file);
  State state;
  state.readable = file;
  const Png png(state, true);
  if (!read_header(png.get(), png.info())) throw BadImage(state.error);
  const int channels = png_get_channels(png.get(), png.info());
  const int bits = png_get_bit_depth(png.get(), png.info());
  const int64_t width = png_get_image_width(png.get(), png.info());
  const int64_t height = png_get_image_height(png.get(), png.info());
  constexpr double most_pixels_per_byte = 8 * 1032;  // deflate's limit, one bit per pixel
  check_header_size(width, height, channels, file.size(), most_pixels_per_byte);
  const size_t row_bytes = png_get_rowbytes(png.get(), png.info());
  Bytes pixels(row_bytes * size_t(height));
  std::vector<uint8_t*> rows = row_pointers(pixels, row_bytes);
  if (!read_rows(png.get(), png.info(), rows.data())) throw BadImage(state.error);
  Image image(int(width), int(height), channel_names_for(channels));
  copy_pixels(pixels, bits, image);
  image.set_srgb_encoded(is_srgb(png.get(), png.info()));
  read_texts(png.get(), png.info(), image);
  return image;
}

}  // namespace kaustik::formats
