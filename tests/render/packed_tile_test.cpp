// Packed sums: exact whatever is added, in any order, and small where numbers are tame.

#include "kaustik/render/packed_tile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace kaustik {
namespace {

constexpr size_t pixels = PictureTiles::pixels;
using Floats = std::array<float, pixels>;
using Doubles = std::array<double, pixels>;

/// The referee: 256 bits in four words, as they are added by hand.
struct WideInteger {
  std::array<uint64_t, 4> words{};
  void add(Fixed value) {
    const uint64_t above = value < 0 ? ~uint64_t(0) : 0;
    const std::array<uint64_t, 4> added = {uint64_t(value), uint64_t(value >> 64), above, above};
    bool carry = false;
    for (size_t i = 0; i < 4; ++i) {
      const uint64_t sum = words[i] + added[i], with_carry = sum + (carry ? 1 : 0);
      carry = sum < words[i] || with_carry < sum;
      words[i] = with_carry;
    }
  }
  /// At ±fixed_limit.
  Fixed cut() const {
    const bool is_negative = words[3] >> 63;
    const uint64_t sign = is_negative ? ~uint64_t(0) : 0;
    const auto low = Fixed(UnsignedFixed(words[1]) << 64 | words[0]);
    if (words[3] != sign || words[2] != sign || (low < 0) != is_negative)
      return is_negative ? -fixed_limit : fixed_limit;
    return std::clamp(low, -fixed_limit, fixed_limit);
  }
};

/// Tiles of three lines: of floats, of their squares and of one that is kept.
constexpr size_t lines = 3;

void add(PackedTile& tile, TilePacker& packer, const Floats& values) {
  Doubles squares;
  for (size_t i = 0; i < pixels; ++i) squares[i] = double(values[i]) * double(values[i]);
  packer.begin(tile);
  packer.add(values);
  packer.add(squares);
  packer.keep();
  packer.end(tile);
}

std::array<Fixed, pixels> read(const PackedTile& tile, size_t line) {
  std::array<Fixed, pixels> sums;
  tile.read(line, lines, sums);
  return sums;
}

void expect_sums(const PackedTile& tile, const std::vector<Floats>& passes) {
  const auto sums = read(tile, 0), squares = read(tile, 1), kept = read(tile, 2);
  std::vector<Fixed> all(pixels * lines);
  tile.read_pixels(lines, 0, pixels, all.data());
  for (size_t i = 0; i < pixels; ++i) {
    WideInteger sum, square;
    for (const Floats& values : passes) {
      sum.add(fixed_from(double(values[i])));
      square.add(fixed_from(double(values[i]) * double(values[i])));
    }
    ASSERT_TRUE(sums[i] == sum.cut()) << i << ": " << double_from(sums[i]);
    ASSERT_TRUE(squares[i] == square.cut()) << i << ": " << double_from(squares[i]);
    ASSERT_TRUE(kept[i] == 0);
    for (size_t line = 0; line < lines; ++line)
      ASSERT_TRUE(tile.at(line, lines, i) == all[i * lines + line]);
    ASSERT_TRUE(all[i * lines] == sums[i] && all[i * lines + 1] == squares[i]);
  }
}

/// What pixels may be.
struct Kind {
  const char* name;
  std::function<float(std::mt19937&, size_t place, size_t pass)> value;
};

float any_float(std::mt19937& random) {
  for (;;) {
    const auto value = std::bit_cast<float>(uint32_t(random()));
    if (std::isfinite(value)) return value;
  }
}

float power(std::mt19937& random, float least, float most) {
  return std::pow(10.0f, std::uniform_real_distribution<float>(least, most)(random));
}

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> list = {
      {"black", [](auto&, size_t, size_t) { return 0.0f; }},
      {"uniform", [](auto&, size_t, size_t) { return 0.7f; }},
      {"uniform in each pass", [](auto&, size_t, size_t pass) { return 0.1f * float(pass); }},
      {"tame", [](auto& random, size_t, size_t) { return power(random, -0.5f, 0.5f); }},
      {"noisy", [](auto& random, size_t, size_t) { return power(random, -6, 3); }},
      {"one in a hundred is bright",
       [](auto& random, size_t, size_t) { return random() % 100 == 0 ? 1e5f : 0.3f; }},
      {"one in six is faint",
       [](auto& random, size_t place, size_t) {
         return place % 6 == 0 ? power(random, -7, -6) : power(random, -0.3f, 0.3f);
       }},
      {"one in six is bright, one in five faint",
       [](auto& random, size_t place, size_t) {
         const float value = power(random, -0.3f, 0.3f);
         return place % 6 == 0 ? -1e6f * value : place % 5 == 0 ? 1e-6f * value : value;
       }},
      {"one in six is faint, one in five giant",
       [](auto& random, size_t place, size_t) {
         const float value = power(random, -0.3f, 0.3f);
         return place % 5 == 0 ? 1e15f * value : place % 6 == 0 ? 1e-8f * value : value;
       }},
      {"one pixel alone", [](auto&, size_t place, size_t) { return place == 77 ? 0.3f : 0; }},
      {"of both signs",
       [](auto& random, size_t, size_t) {
         return (random() & 1 ? 1.0f : -1.0f) * power(random, -3, 3);
       }},
      {"denormals", [](auto& random, size_t,
                       size_t) { return std::bit_cast<float>(uint32_t(random()) & 0x807fffff); }},
      {"at the ends", [](auto& random, size_t, size_t) { return random() & 1 ? 1e30f : -3e38f; }},
      {"up to the end", [](auto& random, size_t, size_t) { return power(random, 15, 21); }},
      {"all floats", [](auto& random, size_t, size_t) { return any_float(random); }},
      {"tame, later all floats",
       [](auto& random, size_t, size_t pass) {
         return pass < 12 ? power(random, -0.5f, 0.5f) : any_float(random);
       }},
      {"a mixture",
       [](auto& random, size_t place, size_t) {
         return place % 3 == 0 ? any_float(random) : place % 3 == 1 ? 0.25f : -1e-18f;
       }},
  };
  return list;
}

std::vector<Floats> passes_of(const Kind& kind, size_t count) {
  std::mt19937 random(7);
  std::vector<Floats> passes(count);
  for (size_t pass = 0; pass < count; ++pass)
    for (size_t i = 0; i < pixels; ++i) passes[pass][i] = kind.value(random, i, pass);
  return passes;
}

TEST(PackedTile, SumsAreThoseOfWideIntegers) {
  for (const Kind& kind : kinds()) {
    SCOPED_TRACE(kind.name);
    const std::vector<Floats> passes = passes_of(kind, 24);
    PackedTile tile;
    TilePacker packer(lines);
    for (const Floats& values : passes) add(tile, packer, values);
    expect_sums(tile, passes);
  }
}

TEST(PackedTile, OrderMakesNoDifference) {
  for (const Kind& kind : kinds()) {
    SCOPED_TRACE(kind.name);
    std::vector<Floats> passes = passes_of(kind, 24);
    PackedTile forward, backward, even, odd;
    TilePacker packer(lines);
    for (const Floats& values : passes) add(forward, packer, values);
    for (size_t i = 0; i < passes.size(); ++i) {
      add(backward, packer, passes[passes.size() - 1 - i]);
      add(i % 2 == 0 ? even : odd, packer, passes[i]);
    }
    packer.add_packed(odd, even.packed());
    for (size_t line = 0; line < lines; ++line) {
      EXPECT_TRUE(read(backward, line) == read(forward, line));
      EXPECT_TRUE(read(odd, line) == read(forward, line));
    }
    const auto repacked = [&](const PackedTile& tile) {
      const auto bytes = packer.repacked(tile);
      return std::vector<uint8_t>(bytes.begin(), bytes.end());
    };
    const std::vector<uint8_t> bytes = repacked(forward);
    EXPECT_TRUE(is_packed_tile(bytes, lines));
    EXPECT_TRUE(repacked(backward) == bytes);
    EXPECT_TRUE(repacked(odd) == bytes);
  }
}

/// Bytes that are damaged, and still look like a tile, are a tile.
TEST(PackedTile, DamagedBytesAreRefusedOrSound) {
  int refused = 0, sound = 0;
  for (const Kind& kind : kinds()) {
    PackedTile tile;
    TilePacker packer(lines);
    for (const Floats& values : passes_of(kind, 3)) add(tile, packer, values);
    const auto span = packer.repacked(tile);
    const std::vector<uint8_t> whole(span.begin(), span.end());
    if (whole.empty()) continue;
    std::mt19937 random(3);
    for (int round = 0; round < 400; ++round) {
      std::vector<uint8_t> bytes = whole;
      // Mostly headers, where the most depends on.
      const size_t most = random() % 2 ? line_header_bytes * lines + 8 : bytes.size();
      bytes[random() % std::min(most, bytes.size())] ^= uint8_t(1 + random() % 255);
      if (random() % 4 == 0) bytes.resize(random() % bytes.size());
      if (!is_packed_tile(bytes, lines)) {
        ++refused;
        continue;
      }
      ++sound;
      // Exactly as many as may be read.
      const size_t size = bytes.size();
      bytes.resize(size + word_slack);
      bytes.shrink_to_fit();
      PackedTile added = tile, alone;
      packer.add_packed(added, std::span(bytes).first(size));
      packer.add_packed(alone, std::span(bytes).first(size));
      for (size_t line = 0; line < lines; ++line) {
        const auto sums = read(added, line), one = read(tile, line), other = read(alone, line);
        for (size_t i = 0; i < pixels; ++i) {
          // Those that are cut are more than they show.
          const bool is_cut = std::max({one[i], -one[i], other[i], -other[i]}) > fixed_limit / 2;
          ASSERT_TRUE(is_cut || sums[i] == one[i] + other[i]) << kind.name << " " << i;
        }
      }
    }
  }
  EXPECT_GT(refused, 400);
  EXPECT_GT(sound, 400);
}

TEST(PackedTile, WhatWasReadCanBeAddedAgain) {
  const std::vector<Floats> passes = passes_of(kinds().back(), 9);
  PackedTile tile, copy;
  TilePacker packer(lines);
  for (const Floats& values : passes) add(tile, packer, values);
  packer.begin(copy);
  for (size_t line = 0; line < lines; ++line) packer.add(read(tile, line));
  packer.end(copy);
  for (size_t line = 0; line < lines; ++line) EXPECT_TRUE(read(copy, line) == read(tile, line));
}

/// Bytes of a pixel's float after so many passes, without what tiles share.
double bytes_of(const char* name, size_t count) {
  const auto kind = std::find_if(kinds().begin(), kinds().end(),
                                 [&](const Kind& k) { return std::string_view(k.name) == name; });
  PackedTile tile;
  TilePacker packer(lines);
  for (const Floats& values : passes_of(*kind, count)) {
    packer.begin(tile);
    packer.add(values);
    packer.keep();
    packer.keep();
    packer.end(tile);
  }
  const size_t shared = 4 * lines + 16;
  return (double(tile.bytes()) - (tile.bytes() > 0 ? double(shared) : 0)) / double(pixels);
}

TEST(PackedTile, TakesWhatTheNumbersNeed) {
  EXPECT_EQ(bytes_of("black", 8), 0);
  EXPECT_EQ(bytes_of("uniform", 100), 16.0 / pixels);
  EXPECT_EQ(bytes_of("one pixel alone", 8), 18.0 / pixels);
  // 24 bits, and what sums of floats of other exponents have more.
  EXPECT_LT(bytes_of("tame", 1), 3.9);
  EXPECT_LT(bytes_of("tame", 16), 4.5);
  EXPECT_LT(bytes_of("tame", 1024), 5.5);
  EXPECT_LT(bytes_of("one in a hundred is bright", 8), 6.5);
  EXPECT_LT(bytes_of("noisy", 64), 8);
  // Bits that few need are kept for these alone: else a word had 50, and 70.
  EXPECT_LT(bytes_of("one in six is faint", 16), 5.6);
  EXPECT_LT(bytes_of("one in six is bright, one in five faint", 16), 6.8);
  // Nothing takes more than this.
  EXPECT_LT(bytes_of("all floats", 64), 52);
}

}  // namespace
}  // namespace kaustik
