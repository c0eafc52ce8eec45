#pragma once
#include <memory>
#include <span>
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
  /// 4 bytes of header for each line, then their contents; empty if all is zero. `word_slack` bytes
  /// more follow.
  std::span<const uint8_t> packed() const;

 private:
  friend class TilePacker;
  const uint8_t* content_of(size_t line, size_t lines) const;
  std::vector<uint8_t> content_;  ///< packed() and what follows
};

/// Whether these bytes are such as TilePacker::repacked() makes of a tile of so many lines.
bool is_packed_tile(std::span<const uint8_t> bytes, size_t lines);

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
  void end(PackedTile& tile);

  /// All lines of a tile that is packed, with `word_slack` bytes that follow it. Begins and ends.
  void add_packed(PackedTile& tile, std::span<const uint8_t> packed);
  /// The tile as if all sums had been added at once: so bytes depend on the sums alone, where those
  /// of the tile depend on the order of adding, too. Until the packer is used again.
  std::span<const uint8_t> repacked(const PackedTile& tile);

 private:
  const uint8_t* header_here() const;
  SumLine& next_line();
  void put_line();
  void copy_line(const LineHeader& header, const uint8_t* content, size_t size);
  std::span<const uint8_t> written() const;

  size_t lines_, line_ = 0;
  const PackedTile* tile_ = nullptr;
  const uint8_t* read_ = nullptr;
  uint8_t* written_ = nullptr;
  std::unique_ptr<uint8_t[]> buffer_;
  std::unique_ptr<SumLine> unpacked_, other_;
};

}  // namespace kaustik
