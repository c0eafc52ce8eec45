// Pictures in terminals: each way to show them is decoded again, by decoders of the test's own.

#include "kaustik/display/terminal.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "kaustik/display/base64.h"
#include "kaustik/display/screen_pixels.h"
#include "kaustik/display/terminal_text.h"
#include "kaustik/image/image_io.h"

namespace kaustik {
namespace {

using Variables = std::map<std::string, std::string>;

std::optional<TerminalKind> kind_of(const Variables& variables) {
  return terminal_kind([&](const std::string& name) {
    const auto found = variables.find(name);
    return found == variables.end() ? std::string() : found->second;
  });
}

TEST(TerminalKind, IsWhatTheTerminalSays) {
  const auto expect = [](const Variables& variables, TerminalGraphics graphics, bool full_colour) {
    const auto kind = kind_of(variables);
    ASSERT_TRUE(kind) << variables.at("TERM");
    EXPECT_EQ(kind->graphics, graphics) << variables.at("TERM");
    EXPECT_EQ(kind->full_colour, full_colour) << variables.at("TERM");
  };
  using enum TerminalGraphics;
  expect({{"TERM", "xterm-kitty"}}, kitty, true);
  expect({{"TERM", "xterm-256color"}, {"KITTY_WINDOW_ID", "1"}}, kitty, true);
  expect({{"TERM", "xterm-ghostty"}}, kitty, true);
  expect({{"TERM", "xterm-256color"}, {"TERM_PROGRAM", "iTerm.app"}}, iterm, true);
  expect({{"TERM", "xterm-256color"}, {"TERM_PROGRAM", "WezTerm"}}, iterm, true);
  expect({{"TERM", "foot"}}, sixel, true);
  expect({{"TERM", "xterm-256color"}, {"COLORTERM", "truecolor"}}, blocks, true);
  expect({{"TERM", "xterm-256color"}}, blocks, false);
  expect({{"TERM", "xterm-direct"}}, blocks, true);
  // What is around them does not get through.
  expect({{"TERM", "tmux-256color"}, {"TMUX", "/tmp/x"}, {"KITTY_WINDOW_ID", "1"}}, blocks, true);
  expect({{"TERM", "xterm-kitty"}, {"TMUX", "/tmp/x"}}, blocks, true);
  expect({{"TERM", "screen.xterm-256color"}, {"TERM_PROGRAM", "iTerm.app"}}, blocks, false);
  EXPECT_FALSE(kind_of({{"TERM", "dumb"}, {"COLORTERM", "truecolor"}}));
  EXPECT_FALSE(kind_of({}));
}

TEST(PicturePlace, KeepsToTheWindowAndToProportions) {
  using enum TerminalGraphics;
  for (const TerminalGraphics graphics : {kitty, iterm, sixel, blocks})
    for (const TerminalSize window : {TerminalSize{80, 24, 0, 0}, TerminalSize{200, 60, 2000, 1200},
                                      TerminalSize{3, 4, 0, 0}, TerminalSize{500, 9, 4000, 162}})
      for (const Vec2i& size : {Vec2i(400, 400), Vec2i(1, 5000), Vec2i(5000, 1), Vec2i(7680, 4320),
                                Vec2i(3, 2), Vec2i(200'000, 100'000)}) {
        SCOPED_TRACE(testing::Message() << int(graphics) << ": " << size.x << " x " << size.y
                                        << " in " << window.columns << " x " << window.rows);
        const int most_rows = window.rows - 2;
        const PicturePlace place = picture_place(size, window, graphics, most_rows);
        ASSERT_GE(place.columns, 1);
        ASSERT_GE(place.rows, 1);
        EXPECT_LT(place.columns, window.columns);
        EXPECT_LE(place.rows, most_rows);
        ASSERT_GE(place.pixels.x, 1);
        ASSERT_GE(place.pixels.y, 1);
        EXPECT_LE(place.pixels.x, size.x);
        EXPECT_LE(place.pixels.y, size.y);
        EXPECT_LE(double(place.pixels.x) * place.pixels.y, 620'000);
        if (graphics == blocks) {
          EXPECT_EQ(place.columns, place.pixels.x);
          EXPECT_EQ(place.rows, (place.pixels.y + 1) / 2);
        }
        // Half a pixel more or less makes no difference to large ones.
        if (graphics != blocks && place.pixels.x > 20 && place.pixels.y > 20) {
          EXPECT_NEAR(double(place.pixels.x) / place.pixels.y / (double(size.x) / size.y), 1, 0.03);
        }
      }
  // A window's characters twice as high as wide: half blocks are squares.
  const PicturePlace place = picture_place({400, 400}, {80, 24, 0, 0}, blocks, 22);
  EXPECT_EQ(place.pixels, Vec2i(44, 44));
}

TEST(Base64, IsThatOfTheStandard) {
  const auto encoded = [](const std::string& text) {
    return base64({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
  };
  // RFC 4648, section 10.
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foob"), "Zm9vYg==");
  EXPECT_EQ(encoded("fooba"), "Zm9vYmE=");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
  EXPECT_EQ(encoded("\xFF\xFB\xBF"), "//u/");
}

/// Colours without any order, which no file makes much smaller.
ScreenPixels many_colours(int width, int height) {
  ScreenPixels pixels{width, height, {}};
  std::mt19937 random(7);
  for (int i = 0; i < 3 * width * height; ++i) pixels.rgb.push_back(uint8_t(random() >> 24));
  return pixels;
}

std::vector<uint8_t> from_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<uint8_t> bytes;
  uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | uint32_t(digits.find(c));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes.push_back(uint8_t(bits >> count));
  }
  return bytes;
}

void expect_png(const std::vector<uint8_t>& png, const ScreenPixels& pixels) {
  const std::string path =
      (std::filesystem::temp_directory_path() / ("terminal_test_" + std::to_string(::getpid())))
          .string();
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(png.data()), std::streamsize(png.size()));
  const Image image = read_image(path);
  std::filesystem::remove(path);
  ASSERT_EQ(image.width(), pixels.width);
  ASSERT_EQ(image.height(), pixels.height);
  EXPECT_EQ(srgb_bytes(image), pixels.rgb);
}

TEST(KittyText, HoldsThePictureInPieces) {
  const ScreenPixels pixels = many_colours(97, 61);
  const std::string text = kitty_text(pixels, {20, 9, {97, 61}}, 77, 76);
  std::vector<std::string> controls, pieces;
  for (size_t at = 0; at < text.size();) {
    ASSERT_EQ(text.substr(at, 3), "\x1b_G");
    const size_t end = text.find("\x1b\\", at);
    ASSERT_NE(end, std::string::npos);
    const std::string command = text.substr(at + 3, end - at - 3);
    const size_t split = std::min(command.find(';'), command.size());
    controls.push_back(command.substr(0, split));
    pieces.push_back(command.substr(std::min(split + 1, command.size())));
    at = end + 2;
  }
  ASSERT_GT(controls.size(), 3u);
  EXPECT_EQ(controls.front(), "a=T,f=100,i=77,c=20,r=9,C=1,q=2,m=1");
  EXPECT_EQ(controls.back(), "a=d,d=I,i=76,q=2");
  std::string data;
  for (size_t i = 0; i + 1 < controls.size(); ++i) {
    const bool is_last = i + 2 == controls.size();
    EXPECT_LE(pieces[i].size(), 4096u);
    EXPECT_TRUE(is_last || pieces[i].size() % 4 == 0);
    EXPECT_TRUE(i == 0 || controls[i] == (is_last ? "m=0" : "m=1")) << controls[i];
    data += pieces[i];
  }
  expect_png(from_base64(data), pixels);
  EXPECT_EQ(kitty_text(pixels, {20, 9, {97, 61}}, 77, 0).find("a=d"), std::string::npos);
}

TEST(ItermText, HoldsThePicture) {
  const ScreenPixels pixels = many_colours(31, 17);
  const std::string text = iterm_text(pixels, {12, 5, {31, 17}});
  const size_t colon = text.find(':');
  ASSERT_NE(colon, std::string::npos);
  ASSERT_EQ(text.back(), '\x07');
  const std::vector<uint8_t> png = from_base64(text.substr(colon + 1, text.size() - colon - 2));
  EXPECT_EQ(text.substr(0, colon), "\x1b]1337;File=size=" + std::to_string(png.size()) +
                                       ";width=12;height=5;preserveAspectRatio=1;inline=1");
  expect_png(png, pixels);
}

/// Reads numbers and characters of a text.
class TextReader {
 public:
  explicit TextReader(const std::string& text) : at_(text.data()), end_(at_ + text.size()) {}
  bool is_at_end() const { return at_ == end_; }
  char next() { return is_at_end() ? '\0' : *at_; }
  bool take(const std::string& wanted) {
    if (std::string_view(at_, size_t(end_ - at_)).substr(0, wanted.size()) != wanted) return false;
    at_ += wanted.size();
    return true;
  }
  int number() {
    int value = -1;
    at_ = std::from_chars(at_, end_, value).ptr;
    return value;
  }
  char character() { return is_at_end() ? '\0' : *at_++; }

 private:
  const char *at_, *end_;
};

/// What xterm shows as colour 16 to 255.
std::array<int, 3> xterm_colour(int index) {
  if (index >= 232) return {8 + 10 * (index - 232), 8 + 10 * (index - 232), 8 + 10 * (index - 232)};
  const auto level = [](int i) { return i == 0 ? 0 : 55 + 40 * i; };
  const int cube = index - 16;
  return {level(cube / 36), level(cube / 6 % 6), level(cube % 6)};
}

/// Colours of the rows of pixels that half blocks show; −1: nothing.
std::vector<std::vector<std::array<int, 3>>> shown_by_blocks(const std::string& text) {
  constexpr std::array<int, 3> nothing = {-1, -1, -1};
  TextReader reader(text);
  std::vector<std::vector<std::array<int, 3>>> rows(2);
  std::array<int, 3> colours[2] = {nothing, nothing};
  while (!reader.is_at_end()) {
    if (reader.take("\r\n")) {
      rows.emplace_back();
      rows.emplace_back();
    } else if (reader.take("\x1b[0m")) {
      colours[0] = colours[1] = nothing;
    } else if (reader.take("\x1b[")) {
      const int which = reader.number() == 38 ? 0 : 1;
      EXPECT_TRUE(reader.take(";"));
      const int way = reader.number();
      EXPECT_TRUE(reader.take(";"));
      if (way == 5) {
        colours[which] = xterm_colour(reader.number());
      } else {
        for (int& value : colours[which]) {
          value = reader.number();
          reader.take(";");
        }
      }
      EXPECT_TRUE(reader.take("m"));
    } else if (reader.take("▀")) {
      rows[rows.size() - 2].push_back(colours[0]);
      rows.back().push_back(colours[1]);
    } else {
      ADD_FAILURE() << "what is this: " << int(reader.character());
      return rows;
    }
  }
  return rows;
}

TEST(BlocksText, ShowsEachPixel) {
  for (const int height : {8, 7, 1}) {
    ScreenPixels pixels = many_colours(13, height);
    // Colours that stay are not told again.
    for (int i = 3; i < 12; ++i) pixels.rgb[size_t(i)] = pixels.rgb[size_t(i % 3)];
    const auto rows = shown_by_blocks(blocks_text(pixels, true));
    ASSERT_EQ(rows.size(), size_t((height + 1) / 2 * 2));
    for (int y = 0; y < int(rows.size()); ++y) {
      ASSERT_EQ(rows[size_t(y)].size(), 13u);
      for (int x = 0; x < 13; ++x)
        for (size_t c = 0; c < 3; ++c)
          EXPECT_EQ(rows[size_t(y)][size_t(x)][c], y < height ? pixels.at(x, y)[c] : -1)
              << x << ", " << y;
    }
  }
}

TEST(BlocksText, TakesTheNearestOf256Colours) {
  const ScreenPixels pixels = many_colours(40, 10);
  const auto rows = shown_by_blocks(blocks_text(pixels, false));
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 40; ++x) {
      const auto distance = [&](const std::array<int, 3>& colour) {
        int sum = 0;
        for (size_t c = 0; c < 3; ++c) sum += int(std::pow(colour[c] - pixels.at(x, y)[c], 2));
        return sum;
      };
      int nearest = 1 << 30;
      for (int index = 16; index < 256; ++index)
        nearest = std::min(nearest, distance(xterm_colour(index)));
      EXPECT_EQ(distance(rows[size_t(y)][size_t(x)]), nearest) << x << ", " << y;
    }
}

/// Decodes sixels as a VT340 with enough registers would; values in percent, −1: nothing drawn.
std::vector<std::array<int, 3>> shown_by_sixels(const std::string& text, int& width, int& height) {
  TextReader reader(text);
  EXPECT_TRUE(reader.take("\x1bP0;1;0q\"1;1;"));
  width = reader.number();
  reader.take(";");
  height = reader.number();
  std::vector<std::array<int, 3>> shown(size_t(width) * size_t(height), {-1, -1, -1});
  std::map<int, std::array<int, 3>> registers;
  int colour = 0, x = 0, top = 0;
  while (!reader.take("\x1b\\") && !reader.is_at_end()) {
    if (reader.take("#")) {
      colour = reader.number();
      if (!reader.take(";2;")) continue;
      for (int& value : registers[colour]) {
        value = reader.number();
        reader.take(";");
      }
    } else if (reader.take("$")) {
      x = 0;
    } else if (reader.take("-")) {
      x = 0;
      top += 6;
    } else {
      const int count = reader.take("!") ? reader.number() : 1;
      const int bits = reader.character() - '?';
      EXPECT_TRUE(bits >= 0 && bits < 64) << bits;
      for (int i = 0; i < count; ++i, ++x)
        for (int row = 0; row < 6; ++row)
          if (bits >> row & 1) {
            EXPECT_TRUE(x < width && top + row < height) << x << ", " << top + row;
            if (x < width && top + row < height)
              shown[size_t(top + row) * size_t(width) + size_t(x)] = registers.at(colour);
          }
    }
  }
  EXPECT_TRUE(reader.is_at_end());
  return shown;
}

TEST(SixelText, ShowsEachPixelAndOnTheMeanItsColour) {
  ScreenPixels flat{24, 16, {}};
  for (int i = 0; i < 24 * 16; ++i) flat.rgb.insert(flat.rgb.end(), {200, 90, 17});
  int width = 0, height = 0;
  const auto shown = shown_by_sixels(sixel_text(flat), width, height);
  ASSERT_EQ(width, 24);
  ASSERT_EQ(height, 16);
  std::array<double, 3> mean{};
  for (const auto& colour : shown)
    for (size_t c = 0; c < 3; ++c) {
      ASSERT_GE(colour[c], 0) << "a pixel is missing";
      mean[c] += colour[c] * 2.55 / double(shown.size());
    }
  // Thresholds are sixteenths of a step, steps are 255/5 or 255/6.
  EXPECT_NEAR(mean[0], 200, 3);
  EXPECT_NEAR(mean[1], 90, 3);
  EXPECT_NEAR(mean[2], 17, 3);
}

TEST(SixelText, IsWithinAStepOfEachColour) {
  const ScreenPixels pixels = many_colours(53, 19);
  int width = 0, height = 0;
  const auto shown = shown_by_sixels(sixel_text(pixels), width, height);
  ASSERT_EQ(shown.size(), 53u * 19u);
  for (size_t i = 0; i < shown.size(); ++i)
    for (size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(shown[i][c] * 2.55, pixels.rgb[3 * i + c], 255.0 / (c == 1 ? 6 : 5) + 2) << i;
}

TEST(ScreenPixels, AreMeansOfBoxes) {
  Image image(6, 4, {"R", "G", "B"});
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 6; ++x) image.at(x, y, 1) = float(x + 10 * y);
  image.at(5, 3, 0) = std::numeric_limits<float>::infinity();
  image.at(4, 3, 0) = std::numeric_limits<float>::quiet_NaN();
  const Image small = shrunk(image, {3, 2});
  ASSERT_EQ(small.width(), 3);
  ASSERT_EQ(small.height(), 2);
  EXPECT_EQ(small.at(0, 0, 1), 5.5f);
  EXPECT_EQ(small.at(1, 1, 1), 27.5f);
  EXPECT_EQ(small.at(2, 1, 1), 24.5f);  // of the two that are finite
  EXPECT_EQ(small.at(2, 1, 0), 0);
  EXPECT_EQ(shrunk(image, {100, 100}).width(), 6);
  EXPECT_EQ(shrunk(image, {1, 1}).pixel_count(), 1u);
}

TEST(ScreenPixels, AreShownByTheOperator) {
  Image image(8, 8, {"R", "G", "B"});
  for (size_t i = 0; i < 64; ++i) image.channel(0)[i] = 0.5f;
  const ScreenPixels pixels = screen_pixels(image, *make_tone_operator("srgb"), {4, 4});
  ASSERT_EQ(pixels.rgb.size(), 48u);
  EXPECT_EQ(pixels.rgb[0], 188);  // of 0.5, IEC 61966-2-1
  EXPECT_EQ(pixels.rgb[1], 0);
  // A scale beside the picture needs its place, too.
  const ScreenPixels scaled = screen_pixels(image, *make_tone_operator("falsecolor"), {4, 4});
  EXPECT_LE(scaled.width, 4);
  EXPECT_LE(scaled.height, 4);
}

}  // namespace
}  // namespace kaustik
