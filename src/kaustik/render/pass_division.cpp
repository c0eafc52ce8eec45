#include "kaustik/render/pass_division.h"

#include <fmt/format.h>

namespace kaustik {
namespace {

/// "part 3 of 64 is", "parts 3, 7–9 of 64 are"
std::string subject(const std::vector<uint32_t>& numbers, uint32_t parts) {
  PassSet set;
  for (const uint32_t number : numbers) set.add({number, number + 1});
  const bool is_one = numbers.size() == 1;
  return fmt::format("part{} {} of {} {}", is_one ? "" : "s", set.text(), parts,
                     is_one ? "is" : "are");
}

}  // namespace

PassRange PassDivision::part(uint32_t index) const {
  const uint64_t count = whole.end - whole.begin;
  const auto place = [&](uint32_t i) { return whole.begin + uint32_t(count * i / parts); };
  return {place(index), place(index + 1)};
}

std::string MissingParts::text(uint32_t parts) const {
  std::string result;
  if (!absent.empty()) result = subject(absent, parts) + " missing";
  if (!absent.empty() && !unfinished.empty()) result += "; ";
  if (!unfinished.empty()) result += subject(unfinished, parts) + " unfinished";
  return result;
}

MissingParts missing_parts(const PassDivision& division, const PassSet& there) {
  MissingParts result;
  for (uint32_t i = 0; i < division.parts; ++i) {
    const PassRange range = division.part(i);
    const uint32_t missing = there.missing(range);
    if (missing == 0) continue;
    const bool is_absent = missing == range.end - range.begin;
    (is_absent ? result.absent : result.unfinished).push_back(i + 1);
  }
  return result;
}

}  // namespace kaustik
