// Truevision TGA 2.0 (file format specification, 1991): grey, true colour and colour mapped, plain
// or run-length encoded.

#include <fmt/format.h>

#include <array>

#include "kaustik/image/byte_reader.h"

namespace kaustik::formats {
namespace {

enum Kind { colour_mapped = 1, true_colour = 2, grey = 3 };

struct TgaHeader {
  int kind = 0;
  bool has_runs = false;
  int64_t width = 0, height = 0;
  int depth = 0;  ///< bits of a stored pixel
  bool has_alpha = false;
  bool is_right_to_left = false, is_top_down = false;
  int first_colour = 0, colour_count = 0, colour_depth = 0;
  size_t colours_at = 0, pixels_at = 0;

  size_t pixel_bytes() const { return size_t(depth + 7) / 8; }
  size_t colour_bytes() const { return size_t(colour_depth + 7) / 8; }
  int channels() const { return (kind == grey ? 1 : 3) + (has_alpha ? 1 : 0); }
};

bool is_colour_depth(int bits) { return bits == 15 || bits == 16 || bits == 24 || bits == 32; }

TgaHeader read_tga_header(const ByteReader& file) {
  TgaHeader h;
  const int type = file.u8(2), map_type = file.u8(1), flags = file.u8(17);
  h.kind = type & 7;
  h.has_runs = (type & 8) != 0;
  h.first_colour = file.u16(3);
  h.colour_count = map_type == 1 ? file.u16(5) : 0;
  h.colour_depth = file.u8(7);
  h.width = file.u16(12);
  h.height = file.u16(14);
  h.depth = file.u8(16);
  h.is_right_to_left = (flags & 0x10) != 0;
  h.is_top_down = (flags & 0x20) != 0;
  h.colours_at = 18 + size_t(file.u8(0));
  h.pixels_at = h.colours_at + size_t(h.colour_count) * (map_type == 1 ? h.colour_bytes() : 0);
  const bool is_known = type <= 11 && map_type <= 1 && (flags & 0xc0) == 0 &&
                        ((h.kind == true_colour && is_colour_depth(h.depth)) ||
                         (h.kind == grey && (h.depth == 8 || h.depth == 16)) ||
                         (h.kind == colour_mapped && (h.depth == 8 || h.depth == 16) &&
                          h.colour_count > 0 && is_colour_depth(h.colour_depth)));
  if (!is_known)
    throw BadImage(
        fmt::format("this kind of TGA is not supported (type {}, {} bits)", type, h.depth));
  // Of 16 bits one may be opacity; many write it as 0 and mean nothing, so it counts for nothing.
  const int colour_bits = h.kind == colour_mapped ? h.colour_depth : h.depth;
  const int alpha_bits = flags & 15;
  h.has_alpha = h.kind == grey ? h.depth == 16 : colour_bits == 32 && alpha_bits == 8;
  return h;
}

using Samples = std::array<uint8_t, 4>;

/// A stored colour (blue first) as samples in the order of the image's channels.
Samples samples_of(ByteView stored) {
  if (stored.size() > 2)
    return {stored[2], stored[1], stored[0], stored.size() > 3 ? stored[3] : uint8_t{255}};
  const unsigned bits = unsigned(stored[0]) | unsigned(stored[1]) << 8;
  const auto five = [](unsigned value) { return uint8_t(((value & 31) * 255 + 15) / 31); };
  return {five(bits >> 10), five(bits >> 5), five(bits), 255};
}

class Pixels {
 public:
  Pixels(const ByteReader& file, const TgaHeader& header)
      : file_(file), header_(header), at_(header.pixels_at) {}

  Samples next() {
    if (!header_.has_runs) return read();
    if (left_ == 0) {
      const uint8_t code = file_.u8(at_++);
      left_ = (code & 127) + 1;
      is_run_ = (code & 128) != 0;
      if (is_run_) repeated_ = read();
    }
    --left_;
    return is_run_ ? repeated_ : read();
  }

 private:
  Samples read() {
    const ByteView stored = file_.bytes(at_, header_.pixel_bytes());
    at_ += stored.size();
    if (header_.kind == grey) return {stored[0], stored.size() > 1 ? stored[1] : uint8_t{255}};
    if (header_.kind == true_colour) return samples_of(stored);
    const int index = stored[0] | (stored.size() > 1 ? stored[1] << 8 : 0);
    const int entry = index - header_.first_colour;
    if (entry < 0 || entry >= header_.colour_count)
      throw BadImage("a pixel's colour is not in the colour map");
    return samples_of(file_.bytes(header_.colours_at + size_t(entry) * header_.colour_bytes(),
                                  header_.colour_bytes()));
  }

  const ByteReader& file_;
  const TgaHeader& header_;
  size_t at_;
  int left_ = 0;
  bool is_run_ = false;
  Samples repeated_{};
};

}  // namespace

Image decode_tga(ByteView bytes, const ReadOptions& options) {
  const ByteReader file(bytes);
  const TgaHeader header = read_tga_header(file);
  const double most_pixels_per_byte = header.has_runs ? 128 : 1;
  check_promise({header.width, header.height, header.channels(), 0, most_pixels_per_byte},
                bytes.size(), options);
  Image image(int(header.width), int(header.height), channel_names_for(header.channels()));
  Pixels pixels(file, header);
  for (int row = 0; row < image.height(); ++row)
    for (int column = 0; column < image.width(); ++column) {
      const Samples samples = pixels.next();
      set_pixel(image, header.is_right_to_left ? image.width() - 1 - column : column,
                header.is_top_down ? row : image.height() - 1 - row, samples.data());
    }
  image.set_srgb_encoded(true);
  return image;
}

}  // namespace kaustik::formats
