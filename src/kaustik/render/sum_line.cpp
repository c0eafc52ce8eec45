#include "kaustik/render/sum_line.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kaustik {
namespace {

/// Power and width of words, and how many of their bits at either end only few have.
struct Window {
  int shift = 0, top = 0, low = 0, high = 0;
};
/// A split must spare a line so many bits: it takes time.
constexpr int price_of_split = 2 * int(words_per_line);
constexpr int bits_of_flags = int(words_per_line);

/// Numbers by their lowest and by their highest bit.
struct BitCounts {
  explicit BitCounts(const std::array<Fixed, words_per_line>& values) {
    for (size_t i = 0; i < words_per_line; ++i) {
      lowest_of[i] = values[i] == 0 ? most : uint8_t(zeros_below(values[i]));
      width_of_value[i] = uint8_t(width_of(values[i]));
      ++lowest[lowest_of[i]];
      ++width[width_of_value[i]];
    }
  }
  int numbers() const { return int(words_per_line) - width[0]; }
  bool fits(size_t i, const Window& window) const {
    return lowest_of[i] >= window.shift && width_of_value[i] <= window.top;
  }
  int outside(const Window& window) const {
    int count = 0;
    for (size_t i = 0; i < words_per_line; ++i) count += fits(i, window) ? 0 : 1;
    return count;
  }

  static constexpr uint8_t most = 129;
  std::array<uint8_t, words_per_line> lowest_of, width_of_value;
  std::array<int, most + 1> lowest{}, width{};
};

/// One end of a window: which bits all have from there on, and how many beyond only few.
struct WindowEnd {
  int core = 0, few = 0;
};

/// What takes least if so many numbers end at each bit, counted away from the core: those that end
/// beyond the few are set aside, and each bit that all have takes one of each number.
template <typename CountAt>
WindowEnd best_end(int bits, const CountAt& count_at) {
  WindowEnd best{bits, 0};
  int least = bits * int(words_per_line), outside = 0;
  for (int end = bits; end >= 0; --end) {
    // `end`: bits that there is room for at all.
    const int set_aside = set_aside_bits * outside;
    if (set_aside >= least) break;
    if (const int cost = set_aside + end * int(words_per_line); cost < least)
      least = cost, best = {end, 0};
    int few = 0;
    for (int core = end - 1; core >= 0 && end - core <= most_narrow; --core) {
      few += count_at(core + 1);
      const int cost = set_aside + core * int(words_per_line) + few * (end - core) + bits_of_flags +
                       price_of_split;
      if (cost < least) least = cost, best = {core, end - core};
      // No fewer have bits beyond a smaller core: it spares this at most.
      if (cost - core * (int(words_per_line) - few) >= least) break;
    }
    outside += count_at(end);
  }
  return best;
}

/// What takes least. Both ends are chosen for themselves.
Window best_window(const BitCounts& counts) {
  int lowest = 0, highest = 0;
  while (lowest < top_of_words && counts.lowest[size_t(lowest)] == 0) ++lowest;
  for (int width = 1; width <= BitCounts::most; ++width)
    if (counts.width[size_t(width)] > 0) highest = std::min(width, top_of_words);
  const int out_of_words =
      std::accumulate(counts.width.begin() + top_of_words + 1, counts.width.end(), 0);
  if (lowest >= highest) return {};
  const int bits = highest - lowest;
  // Of the bits from the highest down, and from the lowest up.
  const WindowEnd below =
      best_end(bits, [&](int end) { return end == 0 ? 0 : counts.lowest[size_t(highest - end)]; });
  const WindowEnd above = best_end(bits, [&](int end) {
    return counts.width[size_t(lowest + end)] +
           (end == bits && highest == top_of_words ? out_of_words : 0);
  });
  Window best{highest - below.core - below.few, lowest + above.core + above.few, below.few,
              above.few};
  if (best.low + best.high >= best.top - best.shift) best.low = best.high = 0;
  best.shift = std::max(best.shift, best.top - most_wide);
  if (best.shift >= best.top) return {};
  if (best.low + best.high >= best.top - best.shift) best.low = best.high = 0;
  return best;
}

}  // namespace

void SumLine::clear() {
  shift_ = width_ = 0;
  is_wide_ = has_window_ = false;
  is_zero_ = true;
  split_ = {};
  words_.fill(0);
  for (const WideWord& wide : set_aside_) set_aside_at_[wide.place] = 0;
  set_aside_.clear();
  set_aside_when_chosen_ = 0;
}

void SumLine::set_aside(size_t place, Fixed value) {
  if (set_aside_at_[place] == 0) {
    set_aside_.push_back({place, {}});
    set_aside_at_[place] = uint16_t(set_aside_.size());
  }
  set_aside_[set_aside_at_[place] - 1u].sum.add(value);
}

void SumLine::add(size_t place, Fixed value) {
  if (value == 0) return;
  if (zeros_below(value) < shift_ || width_of(value) > top_of_words) return set_aside(place, value);
  const Fixed word = value >> shift_;
  if (is_wide_) {
    const Fixed sum = wide_words_[place] + word;
    if (width_of(sum) + shift_ > top_of_words) return set_aside(place, value);
    wide_words_[place] = sum;
    return;
  }
  // Words that are there have no more bits than this, either.
  if (width_of(word) > 62) return set_aside(place, value);
  const int64_t sum = words_[place] + int64_t(word);
  if (width_of(sum) > 62 || width_of(sum) + shift_ > top_of_words) return set_aside(place, value);
  words_[place] = sum;
}

void SumLine::begin_if_zero() {
  if (!is_zero_) return;
  is_wide_ = true;
  is_zero_ = false;
  wide_words_.fill(0);
}

template <typename ValueAt>
void SumLine::add_exact(const ValueAt& value_at) {
  begin_if_zero();
  const int most = top_of_words - shift_;  // bits of a sum
  if (is_wide_) {
    add_each(wide_words_, most, value_at);
  } else {
    add_each(words_, std::min(62, most), value_at);
  }
}

template <typename Words, typename ValueAt>
void SumLine::add_each(Words& words, int most, const ValueAt& value_at) {
  using Word = typename Words::value_type;
  using Unsigned = std::conditional_t<sizeof(Word) == sizeof(uint64_t), uint64_t, UnsignedFixed>;
  constexpr int sign = 8 * int(sizeof(Word)) - 1;
  for (size_t i = 0; i < count; ++i) {
    const Fixed value = value_at(i);
    const auto word = Word(value >> shift_);
    const auto sum = Word(Unsigned(words[i]) + Unsigned(word));
    // Nothing is lost, and neither has more bits.
    const bool fits = Fixed(UnsignedFixed(Fixed(word)) << shift_) == value &&
                      ((word ^ (word >> sign)) | (sum ^ (sum >> sign))) >> (most - 1) == 0;
    if (fits)
      words[i] = sum;
    else
      add(i, value);
  }
}

void SumLine::add(const std::array<Fixed, count>& values) {
  add_exact([&](size_t i) { return values[i]; });
}

void SumLine::add(const std::array<double, count>& values) { add_numbers(values); }

void SumLine::add(const std::array<float, count>& values) { add_numbers(values); }

template <typename Number>
void SumLine::add_numbers(const std::array<Number, count>& values) {
  begin_if_zero();
  // How many words a value is: exact, as long as it is a whole number of them.
  const double words_per_unit = std::ldexp(1.0, 64 - shift_);
  const double most = std::ldexp(1.0, std::min(60, top_of_words - 2 - shift_));
  for (size_t i = 0; i < count; ++i) {
    const double words = double(values[i]) * words_per_unit;
    if (std::abs(words) < most) {
      const auto word = int64_t(words);
      if (double(word) == words) {
        if (is_wide_)
          wide_words_[i] += word;
        else
          words_[i] += word;
        continue;
      }
    }
    add(i, fixed_from(double(values[i])));
  }
}

bool SumLine::add_narrow_words(const SumLine& other) {
  if (is_zero_ || is_wide_ || other.is_wide_) return false;
  const int shift = std::min(shift_, other.shift_);
  const int up = shift_ - shift, other_up = other.shift_ - shift;
  // A bit more than those of the wider one. Words may have grown since they were unpacked.
  const int width = 1 + std::max(width_needed() + up, other.width_needed() + other_up);
  if (width > 62 || width + shift > top_of_words) return false;
  for (size_t i = 0; i < count; ++i)
    words_[i] = int64_t((uint64_t(words_[i]) << up) + (uint64_t(other.words_[i]) << other_up));
  shift_ = shift;
  // Few may have the bits below.
  if (split_.low + up > most_narrow) has_window_ = false;
  if (!has_window_) return true;
  split_.low = uint8_t(split_.low + up);
  width_ += up;
  return true;
}

void SumLine::add(const SumLine& other) {
  if (add_narrow_words(other)) {
  } else if (other.is_wide_) {
    add_exact([&](size_t i) { return other.wide_words_[i] << other.shift_; });
  } else {
    add_exact([&](size_t i) { return Fixed(other.words_[i]) << other.shift_; });
  }
  for (const WideWord& wide : other.set_aside_) {
    set_aside(wide.place, 0);
    set_aside_[set_aside_at_[wide.place] - 1u].sum.add(wide.sum);
  }
}

void SumLine::read(std::array<Fixed, count>& sums) const {
  for (size_t i = 0; i < count; ++i)
    sums[i] = (is_wide_ ? wide_words_[i] : Fixed(words_[i])) << shift_;
  for (const WideWord& wide : set_aside_) {
    WideSum sum = wide.sum;
    sum.add(sums[wide.place]);
    sums[wide.place] = sum.cut();
  }
}

void SumLine::gather(std::array<Fixed, count>& totals) {
  for (size_t i = 0; i < count; ++i)
    totals[i] = (is_wide_ ? wide_words_[i] : Fixed(words_[i])) << shift_;
  size_t kept = 0;
  for (const WideWord& wide : set_aside_) {
    WideSum sum = wide.sum;
    sum.add(totals[wide.place]);
    const Fixed cut = sum.cut();
    const bool is_large = width_of(cut) > top_of_words;
    totals[wide.place] = is_large ? 0 : cut;
    set_aside_at_[wide.place] = is_large ? uint16_t(kept + 1) : 0;
    if (is_large) set_aside_[kept++] = {wide.place, sum};
  }
  set_aside_.resize(kept);
}

void SumLine::choose_window() {
  std::array<Fixed, count> totals;
  gather(totals);
  const BitCounts counts(totals);
  Window window = best_window(counts);
  if (int(count) * (window.top - window.shift) + set_aside_bits * counts.outside(window) >=
      set_aside_bits * counts.numbers())
    window = {};
  shift_ = window.shift;
  width_ = window.top - window.shift;
  is_wide_ = width_ > most_narrow;
  for (size_t i = 0; i < count; ++i) {
    const bool inside = counts.fits(i, window);
    if (!inside) set_aside(i, totals[i]);
    const Fixed word = inside ? totals[i] >> shift_ : 0;
    if (is_wide_)
      wide_words_[i] = word;
    else
      words_[i] = int64_t(word);
  }
  set_aside_when_chosen_ = set_aside_.size();
  split_ = {};
  if (width_ == 0) return;
  split_.low = uint8_t(window.low);
  split_.high = uint8_t(window.high);
  const auto [below, above] = count_split();
  split_.few_low = uint8_t(std::min<size_t>(below, 255));
  split_.few_high = uint8_t(std::min<size_t>(above, 255));
}

std::pair<size_t, size_t> SumLine::count_split() const {
  const auto count_in = [this](const auto& words) {
    const int low = split_.low, core = width_ - low - split_.high;
    size_t below = 0, above = 0;
    for (const auto word : words) {
      below += is_below(word, low) ? 1 : 0;
      above += is_above(word, low, core) ? 1 : 0;
    }
    return std::pair(below, above);
  };
  return is_wide_ ? count_in(wide_words_) : count_in(words_);
}

bool SumLine::is_split_well() const {
  if (!split_.is_split()) return true;
  const auto [below, above] = count_split();
  const auto is_well = [](size_t few, size_t when_chosen) {
    return few <= when_chosen + when_chosen / 4 + 8;
  };
  return is_well(below, split_.few_low) && is_well(above, split_.few_high);
}

void SumLine::make_fit() {
  const int needed = width_needed();
  const size_t tolerated = set_aside_when_chosen_ + set_aside_when_chosen_ / 4 + 2;
  if (!has_window_ || needed > width_ + 1 || set_aside_.size() > tolerated) return choose_window();
  if (needed > width_) {
    // One bit more for all, or those set aside that need it.
    const bool can_grow = width_ + 1 + shift_ <= top_of_words && width_ != most_narrow &&
                          width_ != most_wide && split_.high < most_narrow;
    if (!can_grow || count_beyond(width_) == 1) return choose_window();
    ++width_;
    if (split_.high > 0) ++split_.high;
  }
  if (!is_split_well()) choose_window();
}

int SumLine::width_needed() const {
  if (is_wide_) {
    Fixed any = 0;
    for (const Fixed word : wide_words_) any |= word ^ (word >> 127);
    return width_of(any);
  }
  int64_t any = 0;
  for (const int64_t word : words_) any |= word ^ (word >> 63);
  return width_of(any);
}

size_t SumLine::count_beyond(int width) const {
  size_t beyond = 0;
  for (size_t i = 0; i < count; ++i)
    if ((is_wide_ ? width_of(wide_words_[i]) : width_of(words_[i])) > width) ++beyond;
  return beyond;
}

bool SumLine::is_uniform() const {
  if (!set_aside_.empty()) return false;
  const auto same = [](const auto& words) {
    return words.front() == words.back() &&
           std::all_of(words.begin(), words.end(), [&](auto w) { return w == words.front(); });
  };
  return is_wide_ ? same(wide_words_) : same(words_);
}

const uint8_t* SumLine::unpack(const uint8_t* header_at, const uint8_t* content) {
  clear();
  const auto header = load<LineHeader>(header_at);
  const uint8_t* end = content + content_bytes(header, content);
  is_zero_ = header.counts == 0 && header.packed_width == 0;
  has_window_ = header.counts != uniform_line && !is_zero_;
  if (header.counts == uniform_line) {
    const auto value = load<Fixed>(content);
    // With room for others, below and above.
    shift_ = std::clamp(width_of(value) - 50, 0, zeros_below(value));
    is_wide_ = width_of(value) - shift_ > most_narrow;
    if (is_wide_)
      wide_words_.fill(value >> shift_);
    else
      words_.fill(int64_t(value >> shift_));
    return end;
  }
  shift_ = header.shift;
  width_ = header.width();
  is_wide_ = width_ > most_narrow;
  if (header.is_split()) {
    split_ = load<WordSplit>(content);
    is_wide_ ? read_split_words(content, width_, wide_words_)
             : read_split_words(content, width_, words_);
  } else if (is_wide_) {
    read_words(content, width_, wide_words_);
  } else if (width_ > 0) {
    read_words(content, width_, words_);
  }
  content += word_bytes(header, content);
  set_aside_when_chosen_ = header.counts >> 10;
  for_set_aside(content, header.entries(), [&](size_t place, const WideSum& sum) {
    set_aside_.push_back({place, sum});
    set_aside_at_[place] = uint16_t(set_aside_.size());
  });
  return end;
}

uint8_t* SumLine::write_all(uint8_t* to) const {
  if (split_.is_split())
    return is_wide_ ? write_split_words(wide_words_, width_, split_, to)
                    : write_split_words(words_, width_, split_, to);
  if (is_wide_)
    write_words(wide_words_, width_, to);
  else if (width_ > 0)
    write_words(words_, width_, to);
  return to + words_per_line / 8 * size_t(width_);
}

uint8_t* SumLine::pack(uint8_t* header_at, uint8_t* content) {
  if (is_uniform()) {
    const Fixed value = (is_wide_ ? wide_words_[0] : Fixed(words_[0])) << shift_;
    if (width_of(value) <= top_of_words) {
      const LineHeader header{0, 0, value != 0 ? uniform_line : uint16_t(0)};
      store(header_at, header);
      store(content, value);
      return content + content_bytes(header, content);
    }
  }
  make_fit();
  uint8_t* at = write_all(content);
  uint8_t* const entries = at;
  for (const WideWord& wide : set_aside_) at = write_set_aside(wide.place, wide.sum, at);
  const auto count_of_entries = size_t(at - entries) / entry_bytes;
  const size_t chosen = std::min(set_aside_when_chosen_, most_counted);
  store(header_at, LineHeader{uint8_t(width_ | (split_.is_split() ? split_line : 0)),
                              uint8_t(shift_), uint16_t(count_of_entries | chosen << 10)});
  return at;
}

}  // namespace kaustik
