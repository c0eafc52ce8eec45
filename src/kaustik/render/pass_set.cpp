#include "kaustik/render/pass_set.h"

#include <fmt/format.h>

#include <algorithm>

namespace kaustik {

void PassSet::add(PassRange range) {
  if (range.begin >= range.end) return;
  if (ranges_.empty() || ranges_.back().end < range.begin) return append(range);
  std::vector<PassRange> result;
  for (const PassRange& old : ranges_) {
    if (old.end < range.begin || range.end < old.begin) {
      result.push_back(old);
    } else {
      range.begin = std::min(range.begin, old.begin);
      range.end = std::max(range.end, old.end);
    }
  }
  const auto after = std::find_if(result.begin(), result.end(), [&](const PassRange& other) {
    return other.begin > range.begin;
  });
  result.insert(after, range);
  ranges_.clear();
  count_ = 0;
  for (const PassRange& each : result) append(each);
}

void PassSet::add(const PassSet& other) {
  std::vector<PassRange> all(ranges_.size() + other.ranges_.size());
  std::merge(ranges_.begin(), ranges_.end(), other.ranges_.begin(), other.ranges_.end(),
             all.begin(), [](const PassRange& a, const PassRange& b) { return a.begin < b.begin; });
  ranges_.clear();
  count_ = 0;
  for (PassRange range : all) {
    if (!ranges_.empty() && range.begin <= ranges_.back().end) {
      const PassRange last = ranges_.back();
      ranges_.pop_back();
      count_ -= last.end - last.begin;
      range = {last.begin, std::max(last.end, range.end)};
    }
    append(range);
  }
}

void PassSet::append(PassRange range) {
  ranges_.push_back(range);
  count_ += range.end - range.begin;
}

uint32_t PassSet::count_of_remainder(uint32_t remainder, uint32_t modulus) const {
  const auto before = [&](uint32_t end) {
    return end / modulus + (end % modulus > remainder ? 1 : 0);
  };
  uint32_t sum = 0;
  for (const PassRange& range : ranges_) sum += before(range.end) - before(range.begin);
  return sum;
}

uint32_t PassSet::first_missing(uint32_t from) const {
  // Ranges do not touch, so behind the end of one there is always a gap.
  for (const PassRange& range : ranges_)
    if (range.begin <= from && from < range.end) return range.end;
  return from;
}

PassSet PassSet::common(const PassSet& other) const {
  PassSet result;
  for (auto a = ranges_.begin(), b = other.ranges_.begin();
       a != ranges_.end() && b != other.ranges_.end();) {
    result.add({std::max(a->begin, b->begin), std::min(a->end, b->end)});
    a->end < b->end ? ++a : ++b;
  }
  return result;
}

uint32_t PassSet::missing(PassRange range) const {
  PassSet asked;
  asked.add(range);
  return asked.count() - common(asked).count();
}

std::string PassSet::text() const {
  if (ranges_.empty()) return "none";
  std::vector<std::string> parts;
  for (const PassRange& range : ranges_)
    parts.push_back(range.end == range.begin + 1
                        ? fmt::format("{}", range.begin)
                        : fmt::format("{}–{}", range.begin, range.end - 1));
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace kaustik
