#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

#include "kaustik/image/formats.h"
#include "kaustik/image/tone_mapping.h"

// libpng reports errors by longjmp(), which must not pass the destructor of anything. So every
// function that calls setjmp() here owns nothing but plain values; what needs a destructor lives in
// its caller.

namespace kaustik::formats {
namespace {

/// What is shared with libpng's callbacks.
struct WriteState {
  Bytes written;
  bool lacks_memory = false;
  char error[256] = "";
};

void keep_write_error(png_structp png, png_const_charp text) {
  auto* state = static_cast<WriteState*>(png_get_error_ptr(png));
  std::snprintf(state->error, sizeof(state->error), "%s", text);
  png_longjmp(png, 1);
}
void drop_write_warning(png_structp, png_const_charp) {}

bool append_all(WriteState& state, const uint8_t* data, size_t size) {
  try {
    state.written.insert(state.written.end(), data, data + size);
    return true;
  } catch (const std::bad_alloc&) {
    state.lacks_memory = true;
    return false;
  }
}
void write_some(png_structp png, png_bytep data, size_t size) {
  if (!append_all(*static_cast<WriteState*>(png_get_io_ptr(png)), data, size))
    png_error(png, "not enough memory");
}
void flush_nothing(png_structp) {}

void* allocate_for_writing(png_structp png, png_alloc_size_t size) {
  void* const block = std::malloc(size);
  if (!block) static_cast<WriteState*>(png_get_mem_ptr(png))->lacks_memory = true;
  return block;
}
void release_of_writing(png_structp, void* block) { std::free(block); }

/// A writer of libpng, destroyed with this.
class Writer {
 public:
  explicit Writer(WriteState& state)
      : png_(png_create_write_struct_2(PNG_LIBPNG_VER_STRING, &state, keep_write_error,
                                       drop_write_warning, &state, allocate_for_writing,
                                       release_of_writing)),
        info_(png_ ? png_create_info_struct(png_) : nullptr) {
    if (!info_) {
      png_destroy_write_struct(&png_, &info_);
      throw std::bad_alloc();
    }
    png_set_write_fn(png_, &state, write_some, flush_nothing);
  }
  ~Writer() { png_destroy_write_struct(&png_, &info_); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  png_structp get() const { return png_; }
  png_infop info() const { return info_; }

 private:
  png_structp png_;
  png_infop info_;
};

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

std::vector<uint8_t*> row_pointers(Bytes& pixels, size_t row_bytes) {
  std::vector<uint8_t*> rows;
  for (size_t offset = 0; offset < pixels.size(); offset += row_bytes)
    rows.push_back(pixels.data() + offset);
  return rows;
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
  WriteState state;
  Bytes pixels = srgb_bytes(display_linear);
  std::vector<uint8_t*> rows = row_pointers(pixels, 3 * size_t(display_linear.width()));
  const Texts texts(display_linear);
  const Writer png(state);
  if (!write_all(png.get(), png.info(), uint32_t(display_linear.width()),
                 uint32_t(display_linear.height()), rows.data(), texts.entries.data(),
                 int(texts.entries.size()))) {
    if (state.lacks_memory) throw std::bad_alloc();
    throw BadImage(state.error);
  }
  return std::move(state.written);
}

}  // namespace kaustik::formats
