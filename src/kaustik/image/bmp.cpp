// Windows bitmaps (BITMAPCOREHEADER to BITMAPV5HEADER, Microsoft Learn, "Bitmap Storage"): palettes
// of 1, 4 and 8 bits, 16 to 32 bits by masks, and the two run-length encodings.

#include <fmt/format.h>

#include <array>
#include <bit>
#include <optional>

#include "kaustik/image/byte_reader.h"

namespace kaustik::formats {
namespace {

constexpr size_t file_header_size = 14, core_header_size = 12, info_header_size = 40;

enum Compression : uint32_t { none = 0, rle8 = 1, rle4 = 2, bit_fields = 3, alpha_bit_fields = 6 };

struct Header {
  int64_t width = 0, height = 0;
  bool is_top_down = false;
  int bits = 0;
  uint32_t compression = none;
  std::array<uint32_t, 4> masks{};  ///< of red, green, blue and opacity
  size_t palette_at = 0, palette_entry = 4, palette_count = 0;
  size_t pixels_at = 0;

  bool has_runs() const { return compression == rle8 || compression == rle4; }
  bool has_palette() const { return bits <= 8; }
  bool has_alpha() const { return !has_palette() && masks[3] != 0; }
  /// Lines are padded to multiples of four bytes.
  size_t row_bytes() const { return size_t((width * bits + 31) / 32 * 4); }
};

void read_masks(const ByteReader& file, size_t header_size, Header& h) {
  const bool has_masks = h.compression == bit_fields || h.compression == alpha_bit_fields;
  if (has_masks) {
    // They follow the short header and are part of the longer ones.
    const bool has_alpha_mask = h.compression == alpha_bit_fields || header_size >= 56;
    for (size_t c = 0; c < (has_alpha_mask ? 4u : 3u); ++c)
      h.masks[c] = file.u32(file_header_size + info_header_size + 4 * c);
    if (header_size == info_header_size) h.palette_at += has_alpha_mask ? 16 : 12;
  } else if (h.bits == 16) {
    h.masks = {0x7c00, 0x3e0, 0x1f, 0};
  } else {
    h.masks = {0xff0000, 0xff00, 0xff, 0};
  }
}

Header read_header(const ByteReader& file) {
  Header h;
  h.pixels_at = file.u32(10);
  const size_t header_size = file.u32(14);
  int64_t planes = 1, height = 0;
  if (header_size == core_header_size) {
    h.width = file.u16(18);
    height = file.u16(20);
    h.bits = file.u16(24);
    planes = file.u16(22);
    h.palette_entry = 3;
  } else if (header_size >= info_header_size && header_size <= 256) {
    h.width = file.i32(18);
    height = file.i32(22);
    planes = file.u16(26);
    h.bits = file.u16(28);
    h.compression = file.u32(30);
    h.palette_count = file.u32(46);
  } else {
    throw BadImage("its header has an unknown size");
  }
  h.is_top_down = height < 0;
  h.height = std::abs(height);
  h.palette_at = file_header_size + header_size;
  const bool is_known =
      planes == 1 &&
      ((h.compression == none && (h.bits == 1 || h.bits == 4 || h.bits == 8 || h.bits == 16 ||
                                  h.bits == 24 || h.bits == 32)) ||
       (h.compression == rle8 && h.bits == 8) || (h.compression == rle4 && h.bits == 4) ||
       ((h.compression == bit_fields || h.compression == alpha_bit_fields) &&
        (h.bits == 16 || h.bits == 32)));
  if (!is_known)
    throw BadImage(fmt::format("this kind of BMP is not supported ({} bits, compression {})",
                               h.bits, h.compression));
  if (h.has_palette()) {
    const size_t most = size_t{1} << h.bits;
    if (h.palette_count == 0 || h.palette_count > most) h.palette_count = most;
  } else {
    read_masks(file, header_size, h);
  }
  return h;
}

using Samples = std::array<uint8_t, 4>;

/// The bits of `mask`, 255 if all are set. Masks with gaps count as what lies between their ends.
uint8_t masked(uint32_t pixel, uint32_t mask) {
  if (mask == 0) return 0;
  const int shift = std::countr_zero(mask);
  const uint64_t largest = mask >> shift;
  return uint8_t((uint64_t((pixel & mask) >> shift) * 255 + largest / 2) / largest);
}

class Colours {
 public:
  Colours(const ByteReader& file, const Header& header) : file_(file), header_(header) {}

  Samples of_index(size_t index) const {
    if (index >= header_.palette_count) throw BadImage("a pixel's colour is not in the palette");
    const ByteView entry = file_.bytes(header_.palette_at + index * header_.palette_entry, 3);
    return {entry[2], entry[1], entry[0], 255};
  }
  /// Of pixel `x` of a line that is not run-length encoded.
  Samples in_row(ByteView row, size_t x) const {
    const size_t bits = size_t(header_.bits);
    if (header_.has_palette()) {
      const size_t first_bit = x * bits;
      const int byte = row[first_bit / 8];
      return of_index(size_t(byte >> (8 - bits - first_bit % 8)) & ((size_t{1} << bits) - 1));
    }
    uint32_t pixel = 0;
    for (size_t i = 0; i < bits / 8; ++i) pixel |= uint32_t(row[x * bits / 8 + i]) << (8 * i);
    Samples samples{};
    for (size_t c = 0; c < 4; ++c) samples[c] = masked(pixel, header_.masks[c]);
    return samples;
  }

 private:
  const ByteReader& file_;
  const Header& header_;
};

void read_rows(const ByteReader& file, const Header& header, Image& image) {
  const Colours colours(file, header);
  for (int row = 0; row < image.height(); ++row) {
    const ByteView line =
        file.bytes(header.pixels_at + size_t(row) * header.row_bytes(), header.row_bytes());
    const int y = header.is_top_down ? row : image.height() - 1 - row;
    for (int x = 0; x < image.width(); ++x)
      set_pixel(image, x, y, colours.in_row(line, size_t(x)).data());
  }
}

/// Pairs of a count and a value; a count of zero begins an escape. What is skipped has colour 0.
class RunReader {
 public:
  RunReader(const ByteReader& file, const Header& header, Image& image)
      : file_(file),
        colours_(file, header),
        image_(image),
        at_(header.pixels_at),
        is_nibbles_(header.compression == rle4) {}

  void read() {
    fill_with_first_colour();
    while (true) {
      const size_t count = file_.u8(at_), value = file_.u8(at_ + 1);
      at_ += 2;
      if (count > 0) {
        for (size_t i = 0; i < count; ++i)
          put(is_nibbles_ ? (i % 2 ? value & 15 : value >> 4) : value);
      } else if (value == 0) {
        x_ = 0;
        ++row_;
      } else if (value == 1) {
        return;
      } else if (value == 2) {
        x_ += file_.u8(at_);
        row_ += file_.u8(at_ + 1);
        at_ += 2;
      } else {
        put_literally(value);
      }
    }
  }

 private:
  void fill_with_first_colour() {
    const Samples samples = colours_.of_index(0);
    for (int y = 0; y < image_.height(); ++y)
      for (int x = 0; x < image_.width(); ++x) set_pixel(image_, x, y, samples.data());
  }
  void put_literally(size_t count) {
    const size_t bytes = is_nibbles_ ? (count + 1) / 2 : count;
    const ByteView values = file_.bytes(at_, bytes);
    for (size_t i = 0; i < count; ++i)
      put(!is_nibbles_ ? values[i] : i % 2 ? values[i / 2] & 15u : values[i / 2] >> 4u);
    at_ += bytes + bytes % 2;
  }
  void put(size_t index) {
    if (x_ >= image_.width() || row_ >= image_.height())
      throw BadImage("a run of pixels leaves the picture");
    set_pixel(image_, int(x_++), int(image_.height() - 1 - row_), colours_.of_index(index).data());
  }

  const ByteReader& file_;
  const Colours colours_;
  Image& image_;
  size_t at_;
  bool is_nibbles_;
  int64_t x_ = 0, row_ = 0;
};

}  // namespace

Image decode_bmp(ByteView bytes, const ReadOptions& options) {
  const ByteReader file(bytes);
  const Header header = read_header(file);
  const int channels = header.has_alpha() ? 4 : 3;
  // Runs have 255 pixels in two bytes; they may skip more, which is filled with the first colour.
  const double most_pixels_per_byte = header.has_runs() ? 1000 : 8;
  check_promise({header.width, header.height, channels, 0, most_pixels_per_byte}, bytes.size(),
                options);
  Image image(int(header.width), int(header.height), channel_names_for(channels));
  if (header.has_runs())
    RunReader(file, header, image).read();
  else
    read_rows(file, header, image);
  image.set_srgb_encoded(true);
  return image;
}

}  // namespace kaustik::formats
