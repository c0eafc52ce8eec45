// Radiance's picture format: shared-exponent RGBE pixels, run-length encoded by component (Ward,
// "Real Pixels", Graphics Gems II, 1991; the format's definition is in Radiance's
// doc/filefmts.pdf).

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>

#include "kaustik/image/formats.h"
#include "kaustik/image/photometry.h"
#include "kaustik/image/picture.h"
#include "kaustik/image/primaries.h"

namespace kaustik::formats {
namespace {

using Rgbe = std::array<uint8_t, 4>;

// Scan lines of other lengths cannot be told from flat pixels.
constexpr int shortest_run_length_line = 8;
constexpr int longest_run_length_line = 32767;
constexpr int exponent_bias = 128 + 8;
constexpr float largest_value = 0x1.fep126f;

Rgbe rgbe_from_rgb(Vec3f rgb) {
  for (int c = 0; c < 3; ++c)  // no negative and no NaN values in this format
    rgb[c] = rgb[c] > 0 ? std::min(rgb[c], largest_value) : 0;
  const float largest = std::max({rgb.x, rgb.y, rgb.z});
  if (largest < 1e-32f) return {0, 0, 0, 0};
  int exponent;
  std::frexp(largest, &exponent);
  // Rounded as the decoder adds half a step: what is stored is the floor.
  const float scale = std::ldexp(1.0f, 8 - exponent);
  return {uint8_t(rgb.x * scale), uint8_t(rgb.y * scale), uint8_t(rgb.z * scale),
          uint8_t(exponent + 128)};
}

Vec3f rgb_from_rgbe(const Rgbe& pixel) {
  if (pixel[3] == 0) return Vec3f(0);
  const float scale = std::ldexp(1.0f, int(pixel[3]) - exponent_bias);
  return Vec3f(float(pixel[0]) + 0.5f, float(pixel[1]) + 0.5f, float(pixel[2]) + 0.5f) * scale;
}

/// Length of the run of equal bytes that starts at `x`, at most 127.
int run_length(const std::vector<Rgbe>& line, size_t component, int x) {
  int length = 1;
  while (x + length < int(line.size()) && length < 127 &&
         line[size_t(x + length)][component] == line[size_t(x)][component])
    ++length;
  return length;
}

void encode_component(const std::vector<Rgbe>& line, size_t component, Bytes& bytes) {
  constexpr int shortest_run = 4;
  const int width = int(line.size());
  int x = 0;
  while (x < width) {
    int run_start = x, length = 0;
    while (run_start < width && run_start - x < 128 &&
           (length = run_length(line, component, run_start)) < shortest_run)
      run_start = std::min(run_start + length, x + 128);
    if (run_start > x) {
      const int count = run_start - x;
      bytes.push_back(uint8_t(count));
      for (; x < run_start; ++x) bytes.push_back(line[size_t(x)][component]);
    } else {
      bytes.push_back(uint8_t(128 + length));
      bytes.push_back(line[size_t(x)][component]);
      x += length;
    }
  }
}

void encode_line(const std::vector<Rgbe>& line, Bytes& bytes) {
  const int width = int(line.size());
  if (width < shortest_run_length_line || width > longest_run_length_line) {
    for (const Rgbe& pixel : line) bytes.insert(bytes.end(), pixel.begin(), pixel.end());
    return;
  }
  for (const int value : {2, 2, width >> 8, width & 255}) bytes.push_back(uint8_t(value));
  for (size_t component = 0; component < 4; ++component) encode_component(line, component, bytes);
}

/// Reads on from a position, and throws where the file ends.
class Cursor {
 public:
  explicit Cursor(ByteView file) : rest_(file) {}
  uint8_t byte() {
    if (rest_.empty()) throw BadImage("the file is truncated");
    const uint8_t value = rest_[0];
    rest_ = rest_.subspan(1);
    return value;
  }
  Rgbe pixel() { return {byte(), byte(), byte(), byte()}; }
  std::string line() {
    constexpr size_t longest_line = 65536;
    std::string text;
    for (char c; (c = char(byte())) != '\n';) {
      text += c;
      if (text.size() > longest_line) throw BadImage("its header is not text");
    }
    if (!text.empty() && text.back() == '\r') text.pop_back();
    return text;
  }

 private:
  ByteView rest_;
};

struct RadianceHeader {
  bool is_xyz = false;
  float exposure = 1;         ///< stored values are radiance times this
  Vec3f correction{1, 1, 1};  ///< and times this
  std::optional<ColourMatrix> rec709_from_stored;
  bool is_bottom_up = false, is_right_to_left = false, has_columns_first = false;
  int width = 0, height = 0;
  std::optional<FieldOfView> view;
};

/// So many numbers between white space.
template <size_t count>
std::array<float, count> numbers(const std::string& text, const char* what) {
  std::array<float, count> values;
  std::istringstream in(text);
  for (float& value : values)
    if (!(in >> value) || !std::isfinite(value))
      throw BadImage(fmt::format("'{}' is no {}", text, what));
  return values;
}

float exposure_of(const std::string& text) {
  const float value = numbers<1>(text, "exposure")[0];
  if (!(value > 0)) throw BadImage(fmt::format("'{}' is no exposure", text));
  return value;
}

Vec3f correction_of(const std::string& text) {
  const auto [r, g, b] = numbers<3>(text, "colour correction");
  if (!(r > 0 && g > 0 && b > 0)) throw BadImage(fmt::format("'{}' is no colour correction", text));
  return {r, g, b};
}

std::optional<ColourMatrix> matrix_of(const std::string& text) {
  const auto n = numbers<8>(text, "list of primaries");
  return rec709_from({{n[0], n[1]}, {n[2], n[3]}, {n[4], n[5]}, {n[6], n[7]}});
}

/// "-Y 480 +X 640" and the other seven orders of pixels.
void read_resolution(const std::string& line, RadianceHeader& header) {
  char sign[2], axis[2];
  int length[2];
  std::istringstream in(line);
  if (!(in >> sign[0] >> axis[0] >> length[0] >> sign[1] >> axis[1] >> length[1]))
    throw BadImage("the line with the size is missing");
  for (int i = 0; i < 2; ++i)
    if ((axis[i] != 'X' && axis[i] != 'Y') || (sign[i] != '+' && sign[i] != '-'))
      throw BadImage("the line with the size is malformed");
  if (axis[0] == axis[1]) throw BadImage("the line with the size is malformed");
  header.has_columns_first = axis[0] == 'X';
  const int x = header.has_columns_first ? 0 : 1, y = 1 - x;
  header.width = length[x];
  header.height = length[y];
  header.is_right_to_left = sign[x] == '-';
  header.is_bottom_up = sign[y] == '+';
}

/// The angles of a perspective view: " -vtv -vp 0 1 2 … -vh 45 -vv 30 …". Other projections have
/// none in our sense.
std::optional<FieldOfView> read_view(const std::string& options) {
  std::istringstream in(options);
  FieldOfView view{0, 0};
  for (std::string option; in >> option;) {
    if (option.starts_with("-vt") && option != "-vtv") return std::nullopt;
    if (option == "-vh") in >> view.horizontal;
    if (option == "-vv") in >> view.vertical;
  }
  const auto is_angle = [](float degrees) { return degrees > 0 && degrees < 180; };
  return is_angle(view.horizontal) && is_angle(view.vertical) ? std::optional(view) : std::nullopt;
}

RadianceHeader read_header(Cursor& cursor) {
  RadianceHeader header;
  for (std::string line = cursor.line(); !line.empty(); line = cursor.line()) {
    if (line.starts_with("FORMAT=")) {
      const std::string format = line.substr(7);
      header.is_xyz = format == "32-bit_rle_xyze";
      if (!header.is_xyz && format != "32-bit_rle_rgbe")
        throw BadImage(fmt::format("pixel format '{}' is not supported", format));
    } else if (line.starts_with("EXPOSURE=")) {
      header.exposure *= exposure_of(line.substr(9));  // several multiply
    } else if (line.starts_with("COLORCORR=")) {
      header.correction *= correction_of(line.substr(10));  // so do these
    } else if (line.starts_with("PRIMARIES=")) {
      header.rec709_from_stored = matrix_of(line.substr(10));
    } else if (line.starts_with("VIEW=")) {
      header.view = read_view(line.substr(5));  // the last counts
    }
  }
  read_resolution(cursor.line(), header);
  return header;
}

/// Flat pixels, or runs in the older way: (1, 1, 1, n) repeats the last pixel n times, and directly
/// after such a one n · 256 times.
void read_flat_line(Cursor& cursor, const Rgbe& first, std::vector<Rgbe>& line) {
  int shift = 0;
  size_t x = 0;
  for (Rgbe pixel = first;; pixel = cursor.pixel()) {
    if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
      const size_t count = shift < 24 ? size_t(pixel[3]) << shift : line.size();
      if (x == 0 || count > line.size() - x) throw BadImage("a run of pixels is too long");
      for (size_t i = 0; i < count; ++i, ++x) line[x] = line[x - 1];
      shift += 8;
    } else {
      line[x++] = pixel;
      shift = 0;
    }
    if (x >= line.size()) return;
  }
}

void read_line(Cursor& cursor, std::vector<Rgbe>& line) {
  const Rgbe start = cursor.pixel();
  const size_t width = line.size();
  const bool has_runs = start[0] == 2 && start[1] == 2 && start[2] < 128 &&
                        width >= size_t{shortest_run_length_line} &&
                        width <= size_t{longest_run_length_line};
  if (!has_runs) return read_flat_line(cursor, start, line);
  if ((size_t(start[2]) << 8 | start[3]) != width) throw BadImage("a scan line has a wrong length");
  for (size_t component = 0; component < 4; ++component)
    for (size_t x = 0; x < width;) {
      const uint8_t code = cursor.byte();
      const bool is_run = code > 128;
      const size_t count = is_run ? code - 128u : code;
      if (count == 0 || count > width - x) throw BadImage("a run of pixels is too long");
      uint8_t value = is_run ? cursor.byte() : uint8_t{0};
      for (size_t i = 0; i < count; ++i) {
        if (!is_run) value = cursor.byte();
        line[x++][component] = value;
      }
    }
}

/// Linear Rec. 709.
Vec3f radiance_of(const Rgbe& pixel, const RadianceHeader& header) {
  const Vec3f stored = rgb_from_rgbe(pixel) / header.exposure / header.correction;
  // Radiance's XYZ is in lumens over its efficacy, so Y is photopic radiance as ours is.
  if (header.is_xyz) return rgb_from_xyz(stored);
  return header.rec709_from_stored ? *header.rec709_from_stored * stored : stored;
}

}  // namespace

Bytes encode_hdr(const Image& image, const std::string& layer) {
  const RgbView rgb = rgb_view(image, layer);
  Bytes bytes;
  append(bytes, "#?RADIANCE\nSOFTWARE=Kaustik\n");
  if (const auto view = field_of_view(image); view && view->vertical > 0)
    append(bytes, fmt::format("VIEW= -vtv -vh {} -vv {}\n", view->horizontal, view->vertical));
  append(bytes, "FORMAT=32-bit_rle_rgbe\n\n");
  append(bytes, fmt::format("-Y {} +X {}\n", image.height(), image.width()));
  std::vector<Rgbe> line(size_t(image.width()));
  for (size_t y = 0; y < size_t(image.height()); ++y) {
    for (size_t x = 0; x < line.size(); ++x) line[x] = rgbe_from_rgb(rgb[y * line.size() + x]);
    encode_line(line, bytes);
  }
  return bytes;
}

Image decode_hdr(ByteView file, const ReadOptions& options) {
  Cursor cursor(file);
  const RadianceHeader header = read_header(cursor);
  // The older runs repeat a pixel as often as they like.
  constexpr double most_pixels_per_byte = std::numeric_limits<double>::infinity();
  check_promise({header.width, header.height, 3, 0, most_pixels_per_byte}, file.size(), options);
  Image image(header.width, header.height, {"R", "G", "B"});
  if (header.view) {
    image.set_metadata("horizontal_fov", double(header.view->horizontal));
    image.set_metadata("vertical_fov", double(header.view->vertical));
  }
  const int lines = header.has_columns_first ? header.width : header.height;
  std::vector<Rgbe> line(size_t(header.has_columns_first ? header.height : header.width));
  for (int major = 0; major < lines; ++major) {
    read_line(cursor, line);
    for (int minor = 0; minor < int(line.size()); ++minor) {
      const Vec3f colour = radiance_of(line[size_t(minor)], header);
      int x = header.has_columns_first ? major : minor;
      int y = header.has_columns_first ? minor : major;
      if (header.is_right_to_left) x = header.width - 1 - x;
      if (header.is_bottom_up) y = header.height - 1 - y;
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = colour[c];
    }
  }
  return image;
}

}  // namespace kaustik::formats
