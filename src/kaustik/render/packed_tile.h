#pragma once
#include <memory>
#include <vector>

#include "kaustik/render/sum_line.h"

namespace kaustik {

/// Exact sums of so many numbers of all pixels of a tile, in as few bytes as hold them: what one
/// word of a number needs depends on what the tile shows and grows with the passes, slowly.
class PackedTile {
 public:
  /// Of number `line`, cut at ±fixed_limit; all zero in a tile that nothing was added to.
  void read(size_t line, size_t lines, std::array<Fixed, PictureTiles::pixels>& sums) const;
  /// All lines of so many pixels from the first on: [pixel][line].
  void read_pixels(size_t lines, size_t first, size_t count, Fixed* sums) const;
  /// Of one line and one pixel.
  Fixed at(size_t line, size_t lines, size_t place) const;
  size_t bytes() const { return content_.capacity(); }

 private:
  friend class TilePacker;
  const uint8_t* content_of(size_t line, size_t lines) const;
  std::vector<uint8_t> content_;  ///< 4 bytes of header for each line, then their contents
};

/// Adds to tiles of so many lines: between begin() and end() each line is either kept or added to,
/// in their order.
class TilePacker {
 public:
  explicit TilePacker(size_t lines);
  void begin(const PackedTile& tile);
  void keep();
  /// Values that SumLine::add() takes.
  template <typename Values>
  void add(const Values& values) {
    next_line().add(values);
    put_line();
  }
  /// The same line of another tile of so many lines.
  void add_line_of(const PackedTile& other);
  void end(PackedTile& tile);

 private:
  SumLine& next_line();
  void put_line();

  size_t lines_, line_ = 0;
  const PackedTile* tile_ = nullptr;
  const uint8_t* read_ = nullptr;
  uint8_t* written_ = nullptr;
  std::unique_ptr<uint8_t[]> buffer_;
  std::unique_ptr<SumLine> unpacked_, other_;
};

}  // namespace kaustik
