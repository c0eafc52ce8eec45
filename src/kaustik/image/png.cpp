#include <fmt/format.h>
#include <png.h>

#include <cmath>
#include <csetjmp>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

#include "kaustik/image/formats.h"

// libpng reports errors by longjmp(), which must not pass the destructor of anything. So every
// function that calls setjmp() here owns nothing but plain values; what needs a destructor lives in
// its caller.

namespace kaustik::formats {
namespace {

/// Memory that libpng may hold at a time: for a line of the widest picture or the longest text, not
/// for what a file can pack into compressed texts.
constexpr size_t most_memory = 100'000'000;

/// What is shared with libpng's callbacks.
struct State {
  ByteView readable;
  size_t memory = 0;  ///< that libpng holds
  size_t most_memory = formats::most_memory;
  bool is_over_limit = false, lacks_memory = false;
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

/// Before each block stands its size.
constexpr size_t block_head = alignof(std::max_align_t);

void* allocate(png_structp png, png_alloc_size_t size) {
  auto* state = static_cast<State*>(png_get_mem_ptr(png));
  if (size > state->most_memory || state->memory > state->most_memory - size) {
    state->is_over_limit = true;
    return nullptr;
  }
  void* block = std::malloc(block_head + size);
  if (!block) {
    state->lacks_memory = true;
    return nullptr;
  }
  state->memory += size;
  std::memcpy(block, &size, sizeof(size));
  return static_cast<char*>(block) + block_head;
}

void release(png_structp png, void* memory) {
  if (!memory) return;
  char* block = static_cast<char*>(memory) - block_head;
  png_alloc_size_t size;
  std::memcpy(&size, block, sizeof(size));
  static_cast<State*>(png_get_mem_ptr(png))->memory -= size;
  std::free(block);
}

/// A reader of libpng, destroyed with this.
class Reader {
 public:
  explicit Reader(State& state)
      : png_(png_create_read_struct_2(PNG_LIBPNG_VER_STRING, &state, keep_error, drop_warning,
                                      &state, allocate, release)),
        info_(png_ ? png_create_info_struct(png_) : nullptr) {
    if (!info_) {
      png_destroy_read_struct(&png_, &info_, nullptr);
      throw std::bad_alloc();
    }
    png_set_read_fn(png_, &state, read_some);
  }
  ~Reader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  png_structp get() const { return png_; }
  png_infop info() const { return info_; }

 private:
  png_structp png_;
  png_infop info_;
};

/// Reads all before the pixels and asks for 8 or 16 bit samples without palettes.
bool read_header(png_structp png, png_infop info) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_user_limits(png, INT32_MAX, INT32_MAX);  // checked by check_promise()
  png_set_chunk_cache_max(png, 0);                 // counted by check_chunks()
  // A damaged text is damage too: it may be the field of view.
  png_set_crc_action(png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
  png_read_info(png, info);
  png_set_expand(png);  // palettes, 1 to 4 bits, transparent colours
  png_read_update_info(png, info);
  return true;
}

/// The next line of the pass into `row`.
bool read_row(png_structp png, uint8_t* row) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_read_row(png, row, nullptr);
  return true;
}

bool read_end(png_structp png, png_infop info) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_read_end(png, info);
  return true;
}

[[noreturn]] void fail(const State& state) {
  if (state.lacks_memory) throw std::bad_alloc();
  throw BadImage(state.is_over_limit
                     ? fmt::format("its texts and profiles take more than {} MB of memory",
                                   most_memory / 1'000'000)
                     : state.error);
}

/// Every chunk up to the end mark lies within the file: libpng allocates a chunk's length before it
/// reads, so a corrupt one would cost gigabytes. Texts it would copy again for every few more.
void check_chunks(ByteView file) {
  constexpr size_t signature = 8, around_data = 12;  // length, type and checksum
  constexpr int most_texts = 10000;
  int texts = 0;
  for (size_t position = signature;;) {
    if (position > file.size() || file.size() - position < around_data)
      throw BadImage("the file is truncated");
    const uint8_t* chunk = file.data() + position;
    const size_t length =
        size_t(chunk[0]) << 24 | size_t(chunk[1]) << 16 | size_t(chunk[2]) << 8 | size_t(chunk[3]);
    if (length > file.size() - position - around_data)
      throw BadImage("the file is truncated, or the length of a chunk is corrupt");
    if (std::memcmp(chunk + 4, "IEND", 4) == 0) return;
    const std::string_view type(reinterpret_cast<const char*>(chunk) + 4, 4);
    if ((type == "tEXt" || type == "zTXt" || type == "iTXt") && ++texts > most_texts)
      throw BadImage(fmt::format("it has more than {} texts", most_texts));
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

void read_texts(png_structp png, png_infop info, Image& image) {
  png_textp texts = nullptr;
  const int count = png_get_text(png, info, &texts, nullptr);
  for (int i = 0; i < count; ++i)
    if (texts[i].key && texts[i].text) image.set_metadata(texts[i].key, std::string(texts[i].text));
}

/// Every `step_x`-th pixel of line y, from `x` on.
void copy_row(const uint8_t* row, int bits, int x, int step_x, int y, Image& image) {
  const size_t channels = size_t(image.channel_count());
  for (size_t sample = 0; x < image.width(); x += step_x)
    for (size_t c = 0; c < channels; ++c, ++sample) {
      const int value = bits == 16 ? row[2 * sample] << 8 | row[2 * sample + 1] : int(row[sample]);
      image.at(x, y, int(c)) = float(value) / (bits == 16 ? 65535.0f : 255.0f);
    }
}

/// Line by line into the image; interlaced pictures come in seven passes.
void read_pixels(const Reader& png, const State& state, int bits, Image& image) {
  const bool is_interlaced = png_get_interlace_type(png.get(), png.info()) == PNG_INTERLACE_ADAM7;
  std::vector<uint8_t> row(png_get_rowbytes(png.get(), png.info()));
  for (int pass = 0; pass < (is_interlaced ? 7 : 1); ++pass) {
    const int x = is_interlaced ? PNG_PASS_START_COL(pass) : 0;
    const int step_x = is_interlaced ? PNG_PASS_COL_OFFSET(pass) : 1;
    const int step_y = is_interlaced ? PNG_PASS_ROW_OFFSET(pass) : 1;
    if (x >= image.width()) continue;  // the pass is empty
    for (int y = is_interlaced ? PNG_PASS_START_ROW(pass) : 0; y < image.height(); y += step_y) {
      if (!read_row(png.get(), row.data())) fail(state);
      copy_row(row.data(), bits, x, step_x, y, image);
    }
  }
}

}  // namespace

Image decode_png(ByteView file, const ReadOptions& options) {
  check_chunks(file);
  State state;
  state.readable = file;
  const Reader png(state);
  if (!read_header(png.get(), png.info())) fail(state);
  const int channels = png_get_channels(png.get(), png.info());
  const int bits = png_get_bit_depth(png.get(), png.info());
  const int64_t width = png_get_image_width(png.get(), png.info());
  const int64_t height = png_get_image_height(png.get(), png.info());
  constexpr double most_pixels_per_byte = 8 * 1032;  // deflate's limit, one bit per pixel
  check_promise({width, height, channels, 0, most_pixels_per_byte}, file.size(), options);
  // Some lines beside the one that is read here.
  state.most_memory += 8 * png_get_rowbytes(png.get(), png.info());
  Image image(int(width), int(height), channel_names_for(channels));
  read_pixels(png, state, bits, image);
  if (!read_end(png.get(), png.info())) fail(state);
  image.set_srgb_encoded(is_srgb(png.get(), png.info()));
  read_texts(png.get(), png.info(), image);
  return image;
}

}  // namespace kaustik::formats
