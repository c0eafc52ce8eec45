#include "kaustik/render/split_words.h"

namespace kaustik {
namespace {

constexpr size_t flag_bytes = words_per_line / 8;

size_t bytes_of(size_t count, int width) { return (count * size_t(width) + 7) / 8; }

bool flag_at(const uint8_t* flags, size_t place) {
  return (flags[place / 8] >> place % 8 & 1) != 0;
}

size_t flags_before(const uint8_t* flags, size_t place) {
  size_t count = 0;
  for (size_t i = 0; i < place / 8; ++i) count += size_t(std::popcount(flags[i]));
  return count + size_t(std::popcount(uint8_t(flags[place / 8] & ((1u << place % 8) - 1))));
}

/// Flags and the words of those that are flagged; returns the end.
template <typename IsFlagged, typename BitsOf>
uint8_t* write_few(int width, const IsFlagged& is_flagged, const BitsOf& bits_of, uint8_t* to) {
  uint8_t* const flags = to;
  std::memset(flags, 0, flag_bytes);
  to += flag_bytes;
  const uint64_t mask = (uint64_t(1) << width) - 1;
  uint64_t waiting = 0;
  int waiting_bits = 0;  // fewer than 8
  for (size_t i = 0; i < words_per_line; ++i) {
    if (!is_flagged(i)) continue;
    flags[i / 8] = uint8_t(flags[i / 8] | 1u << i % 8);
    waiting |= (uint64_t(bits_of(i)) & mask) << waiting_bits;
    waiting_bits += width;
    store(to, waiting);
    to += waiting_bits / 8;
    waiting >>= waiting_bits / 8 * 8;
    waiting_bits %= 8;
  }
  return to + (waiting_bits > 0 ? 1 : 0);
}

/// Calls take(place, word) for all that are flagged; returns the end.
template <typename Take>
const uint8_t* read_few(const uint8_t* from, int width, const Take& take) {
  const uint8_t* const words = from + flag_bytes;
  size_t count = 0;
  for (size_t group = 0; group < words_per_line; group += 64)
    for (auto flags = load<uint64_t>(from + group / 8); flags != 0; flags &= flags - 1)
      take(group + size_t(std::countr_zero(flags)), word_at<int64_t>(words, width, count++));
  return words + bytes_of(count, width);
}

template <typename Words>
uint8_t* write_split(const Words& words, int width, WordSplit split, uint8_t* const begin) {
  using Word = typename Words::value_type;
  const int low = split.low, core = width - low - split.high;
  uint8_t* to = begin + sizeof split;
  if (core <= most_narrow) {
    NarrowWords cores;
    for (size_t i = 0; i < words_per_line; ++i) cores[i] = int64_t(words[i] >> low);
    write_words(cores, core, to);
  } else if constexpr (sizeof(Word) > sizeof(int64_t)) {
    WideWords cores;
    for (size_t i = 0; i < words_per_line; ++i) cores[i] = words[i] >> low;
    write_words(cores, core, to);
  }
  to += flag_bytes * size_t(core);
  if (low > 0)
    to = write_few(
        low, [&](size_t i) { return is_below(words[i], low); }, [&](size_t i) { return words[i]; },
        to);
  if (split.high > 0)
    to = write_few(
        split.high, [&](size_t i) { return is_above(words[i], low, core); },
        [&](size_t i) { return words[i] >> (low + core); }, to);
  split.bytes = uint16_t(to - begin);
  store(begin, split);
  return to;
}

template <typename Words>
void read_split(const uint8_t* from, int width, Words& words) {
  using Word = typename Words::value_type;
  const auto split = load<WordSplit>(from);
  const int low = split.low, core = width - low - split.high;
  from += sizeof split;
  if (core <= most_narrow) {
    NarrowWords cores;
    read_words(from, core, cores);
    for (size_t i = 0; i < words_per_line; ++i) words[i] = Word(cores[i]) << low;
  } else if constexpr (sizeof(Word) > sizeof(int64_t)) {
    read_words(from, core, words);
    for (Word& word : words) word <<= low;
  }
  from += flag_bytes * size_t(core);
  if (low > 0)
    from = read_few(from, low, [&](size_t i, int64_t bits) {
      words[i] |= Word(uint64_t(bits) & ((uint64_t(1) << low) - 1));
    });
  if (split.high > 0)
    read_few(from, split.high, [&](size_t i, int64_t bits) {
      const Word below = (Word(1) << (low + core)) - 1;
      words[i] = (words[i] & below) | Word(bits) << (low + core);
    });
}

}  // namespace

uint8_t* write_split_words(const NarrowWords& words, int width, WordSplit split, uint8_t* to) {
  return write_split(words, width, split, to);
}

uint8_t* write_split_words(const WideWords& words, int width, WordSplit split, uint8_t* to) {
  return write_split(words, width, split, to);
}

void read_split_words(const uint8_t* from, int width, NarrowWords& words) {
  read_split(from, width, words);
}

void read_split_words(const uint8_t* from, int width, WideWords& words) {
  read_split(from, width, words);
}

std::optional<size_t> checked_split_bytes(int width, const uint8_t* from, size_t most) {
  if (most < sizeof(WordSplit)) return std::nullopt;
  const auto split = load<WordSplit>(from);
  const int core = width - split.low - split.high;
  if (!split.is_split() || split.low > most_narrow || split.high > most_narrow || core < 1)
    return std::nullopt;
  size_t size = sizeof split + flag_bytes * size_t(core);
  for (const int end : {int(split.low), int(split.high)}) {
    if (end == 0) continue;
    if (size + flag_bytes > most) return std::nullopt;
    size_t count = 0;
    for (size_t i = 0; i < flag_bytes; ++i) count += size_t(std::popcount(from[size + i]));
    size += flag_bytes + bytes_of(count, end);
  }
  return size <= most && size == split.bytes ? std::optional(size) : std::nullopt;
}

SplitReader::SplitReader(const uint8_t* from, int width, size_t first) : place_(first) {
  const auto split = load<WordSplit>(from);
  low_ = split.low;
  core_ = width - split.low - split.high;
  core_words_ = from + sizeof split;
  const uint8_t* end = core_words_ + flag_bytes * size_t(core_);
  end = place_end(below_, end, split.low, first);
  place_end(above_, end, split.high, first);
}

const uint8_t* SplitReader::place_end(End& end, const uint8_t* from, int width,
                                      size_t first) const {
  if (width == 0) return from;
  end = {from, from + flag_bytes, width, flags_before(from, first)};
  return end.words + bytes_of(flags_before(from, words_per_line - 1) +
                                  (flag_at(from, words_per_line - 1) ? 1 : 0),
                              width);
}

bool SplitReader::End::take(size_t place, int64_t& word) {
  if (width == 0 || !flag_at(flags, place)) return false;
  word = word_at<int64_t>(words, width, before++);
  return true;
}

Fixed SplitReader::next() {
  const Fixed core = core_ > most_narrow ? word_at<Fixed>(core_words_, core_, place_)
                                         : Fixed(word_at<int64_t>(core_words_, core_, place_));
  Fixed word = core << low_;
  int64_t bits = 0;
  if (below_.take(place_, bits)) word |= Fixed(uint64_t(bits) & ((uint64_t(1) << low_) - 1));
  if (above_.take(place_, bits)) {
    const int below = low_ + core_;
    word = (word & ((Fixed(1) << below) - 1)) | Fixed(bits) << below;
  }
  ++place_;
  return word;
}

}  // namespace kaustik
