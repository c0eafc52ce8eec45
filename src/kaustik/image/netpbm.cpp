// PFM (portable float map) and the PNM family (PPM and PGM, binary and text).

#include <fmt/format.h>

#include <bit>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "kaustik/image/formats.h"
#include "kaustik/image/tone_mapping.h"

namespace kaustik::formats {
namespace {

/// Words between white space, then the bytes after them.
class Tokens {
 public:
  explicit Tokens(ByteView file) : rest_(file) {}

  /// The next word, with comments from '#' to the end of the line left out; one white space after
  /// it is taken too, so that binary data may follow.
  std::string word() {
    skip_space_and_comments();
    constexpr size_t longest_word = 64;
    std::string text;
    while (!rest_.empty() && !std::isspace(rest_[0])) {
      text += char(take());
      if (text.size() > longest_word) throw BadImage("its header is not text");
    }
    if (text.empty()) throw BadImage("the file is truncated");
    if (!rest_.empty()) take();
    return text;
  }

  int number() {
    const std::string text = word();
    char* end = nullptr;
    const long value = std::strtol(text.c_str(), &end, 10);
    if (*end != 0 || value < 0 || value > INT32_MAX)
      throw BadImage(fmt::format("'{}' is no number that fits here", text));
    return int(value);
  }

  ByteView rest() const { return rest_; }

 private:
  uint8_t take() {
    const uint8_t value = rest_[0];
    rest_ = rest_.subspan(1);
    return value;
  }
  void skip_space_and_comments() {
    while (!rest_.empty() && (std::isspace(rest_[0]) || rest_[0] == '#')) {
      if (take() != '#') continue;
      while (!rest_.empty() && rest_[0] != '\n') take();
    }
  }

  ByteView rest_;
};

float float_at(ByteView bytes, size_t index, bool is_big_endian) {
  uint32_t bits = 0;
  for (size_t i = 0; i < 4; ++i)
    bits |= uint32_t(bytes[4 * index + i]) << (8 * (is_big_endian ? 3 - i : i));
  return std::bit_cast<float>(bits);
}

}  // namespace

Bytes encode_pfm(const Image& image, const std::string& layer) {
  static_assert(std::endian::native == std::endian::little, "the scale below says little endian");
  const RgbView rgb = rgb_view(image, layer);
  Bytes bytes;
  bytes.reserve(12 * image.pixel_count() + 64);
  append(bytes, fmt::format("PF\n{} {}\n-1.0\n", image.width(), image.height()));
  const size_t width = size_t(image.width());
  for (size_t y = size_t(image.height()); y-- > 0;)  // bottom up
    for (size_t x = 0; x < width; ++x)
      for (const auto& plane : rgb.planes) {
        const auto value = std::bit_cast<std::array<uint8_t, 4>>(plane[y * width + x]);
        bytes.insert(bytes.end(), value.begin(), value.end());
      }
  return bytes;
}

Image decode_pfm(ByteView file, const ReadOptions& options) {
  Tokens tokens(file);
  const int channels = tokens.word() == "PF" ? 3 : 1;
  const int width = tokens.number(), height = tokens.number();
  const std::string scale_text = tokens.word();
  char* end = nullptr;
  const float scale = std::strtof(scale_text.c_str(), &end);
  if (*end != 0 || scale == 0 || !std::isfinite(scale))
    throw BadImage(fmt::format("'{}' is no scale", scale_text));
  check_promise({width, height, channels, 0, 0.25}, file.size(), options);
  const size_t pixels = size_t(width) * size_t(height);
  if (tokens.rest().size() / 4 / size_t(channels) < pixels) throw BadImage("the file is truncated");
  Image image(width, height, channel_names_for(channels));
  size_t index = 0;
  for (int y = height - 1; y >= 0; --y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < channels; ++c)
        image.at(x, y, c) = float_at(tokens.rest(), index++, scale > 0) * std::fabs(scale);
  return image;
}

Bytes encode_ppm(const Image& display_linear) {
  Bytes bytes;
  append(bytes, fmt::format("P6\n{} {}\n255\n", display_linear.width(), display_linear.height()));
  const Bytes pixels = srgb_bytes(display_linear);
  bytes.insert(bytes.end(), pixels.begin(), pixels.end());
  return bytes;
}

Image decode_pnm(ByteView file, const ReadOptions& options) {
  Tokens tokens(file);
  const char kind = tokens.word()[1];
  const int channels = kind == '3' || kind == '6' ? 3 : 1;
  const bool is_text = kind == '2' || kind == '3';
  const int width = tokens.number(), height = tokens.number(), maximum = tokens.number();
  if (maximum < 1 || maximum > 65535)
    throw BadImage(fmt::format("a maximum of {} is not possible", maximum));
  check_promise({width, height, channels, 0, 1}, file.size(), options);
  const size_t sample_bytes = maximum > 255 ? 2 : 1;
  const size_t samples = size_t(width) * size_t(height) * size_t(channels);
  const ByteView binary = tokens.rest();
  if (!is_text && binary.size() / sample_bytes < samples) throw BadImage("the file is truncated");
  Image image(width, height, channel_names_for(channels));
  image.set_srgb_encoded(true);
  size_t index = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < channels; ++c, ++index) {
        int value;
        if (is_text)
          value = tokens.number();
        else if (sample_bytes == 1)
          value = binary[index];
        else
          value = binary[2 * index] << 8 | binary[2 * index + 1];
        if (value > maximum) throw BadImage("a value is above the maximum of the header");
        image.at(x, y, c) = float(value) / float(maximum);
      }
  return image;
}

}  // namespace kaustik::formats
