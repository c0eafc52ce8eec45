#pragma once
// Words of which few have bits at one of their ends: these bits are stored for those few alone.

#include <optional>

#include "kaustik/render/packed_words.h"

namespace kaustik {

/// How words of a width are split: all have a core, and those that a bit each tells have bits below
/// it, or above it.
struct WordSplit {
  uint16_t bytes = 0;         ///< that all takes, this included
  uint8_t low = 0, high = 0;  ///< bits below and above the core, up to most_narrow each
  uint8_t few_low = 0,
          few_high = 0;  ///< words that had such bits when the split was chosen, or 255

  bool is_split() const { return low > 0 || high > 0; }
};

/// Whether a word has bits above a core of at least one bit that begins at bit `low`.
template <typename Word>
bool is_above(Word word, int low, int core) {
  using Unsigned = std::conditional_t<sizeof(Word) == 8, uint64_t, UnsignedFixed>;
  return (Unsigned(word >> low) + (Unsigned(1) << (core - 1))) >> core != 0;
}

template <typename Word>
bool is_below(Word word, int low) {
  return (word & ((Word(1) << low) - 1)) != 0;
}

// `words` are of a width that `Word` holds: NarrowWords or WideWords.

/// Writes up to `word_slack` bytes more; returns the end. `split.bytes` is set here.
uint8_t* write_split_words(const NarrowWords& words, int width, WordSplit split, uint8_t* to);
uint8_t* write_split_words(const WideWords& words, int width, WordSplit split, uint8_t* to);
/// Reads up to `word_slack` bytes more.
void read_split_words(const uint8_t* from, int width, NarrowWords& words);
void read_split_words(const uint8_t* from, int width, WideWords& words);

/// Bytes that they take, of words of that width, where nobody knows what the bytes are, of which
/// there are `most`: nothing unless they are such as write_split_words() writes.
std::optional<size_t> checked_split_bytes(int width, const uint8_t* from, size_t most);

/// Reads one word after the other.
class SplitReader {
 public:
  SplitReader(const uint8_t* from, int width, size_t first);
  Fixed next();

 private:
  /// Bits of those that have any.
  struct End {
    const uint8_t *flags = nullptr, *words = nullptr;
    int width = 0;
    size_t before = 0;
    /// The next word, if the one at this place has one.
    bool take(size_t place, int64_t& word);
  };
  const uint8_t* place_end(End& end, const uint8_t* from, int width, size_t first) const;

  const uint8_t* core_words_;
  int low_, core_;
  size_t place_;
  End below_, above_;
};

}  // namespace kaustik
