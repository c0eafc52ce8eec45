#pragma once
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "kaustik/render/packed_line.h"

namespace kaustik {

/// The sums of one number of all pixels of a tile, exact: each is a word times a power of two that
/// all share, plus a wide sum where there are parts that do not fit into words.
class SumLine {
 public:
  static constexpr size_t count = PictureTiles::pixels;

  void clear();
  // All values must be finite; they count as fixed_from() makes them.
  void add(const std::array<float, count>& values);
  void add(const std::array<double, count>& values);
  void add(const std::array<Fixed, count>& values);
  void add(const SumLine& other);
  /// All sums, cut at ±fixed_limit.
  void read(std::array<Fixed, count>& sums) const;

  /// Bytes that packing takes at most.
  static constexpr size_t largest_packed = 16 * count + 36 * count + 256;
  /// Reads what pack() has written; returns its end.
  const uint8_t* unpack(const uint8_t* header, const uint8_t* content);
  /// Writes in as few bytes as can be without much ado: 4 of header, and content. Returns its end.
  uint8_t* pack(uint8_t* header, uint8_t* content);

 private:
  struct WideWord {
    size_t place;
    WideSum sum;
  };
  void begin_if_zero();
  /// False, and nothing is added, unless both have narrow words and no sum needs more.
  bool add_narrow_words(const SumLine& other);
  void add(size_t place, Fixed value);
  template <typename ValueAt>
  void add_exact(const ValueAt& value_at);
  /// Whose sums have at most so many bits.
  template <typename Words, typename ValueAt>
  void add_each(Words& words, int most, const ValueAt& value_at);
  template <typename Number>
  void add_numbers(const std::array<Number, count>& values);
  void set_aside(size_t place, Fixed value);
  /// All words as Fixed, with what was set aside if that is possible.
  void gather(std::array<Fixed, count>& totals);
  /// Makes words fit into their width.
  void make_fit();
  /// Chooses power and width anew, by what takes least memory.
  void choose_window();
  int width_needed() const;
  size_t count_beyond(int width) const;
  /// Words with bits below and above the core.
  std::pair<size_t, size_t> count_split() const;
  /// Whether as few words as when the split was chosen have bits beside the core.
  bool is_split_well() const;
  bool is_uniform() const;
  uint8_t* write_all(uint8_t* to) const;

  int shift_ = 0, width_ = 0;  ///< bits: a word is less than 2^(width − 1), either way
  bool is_wide_ = false;       ///< which of the two holds the words
  bool is_zero_ = true;        ///< nothing was added
  bool has_window_ = false;    ///< power and width were chosen
  WordSplit split_;
  std::array<int64_t, count> words_{};
  std::array<Fixed, count> wide_words_;
  std::vector<WideWord> set_aside_;
  std::array<uint16_t, count> set_aside_at_{};  ///< one more than the index in it; 0: none
  size_t set_aside_when_chosen_ = 0;
};

}  // namespace kaustik
