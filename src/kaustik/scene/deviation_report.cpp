#include "kaustik/scene/deviation_report.h"

#include <fmt/format.h>

#include <algorithm>

namespace kaustik {
namespace {

constexpr size_t told_in_summary = 3;
constexpr DeviationKind kinds[] = {DeviationKind::approximated, DeviationKind::ignored,
                                   DeviationKind::missing};

std::string line_of(const Deviation& deviation) {
  const std::string place = text_of(deviation.place);
  return fmt::format("{}: {}: {}{}", name_of(deviation.kind), deviation.object, deviation.what,
                     place.empty() ? "" : " (" + place + ")");
}

}  // namespace

std::string deviation_counts(const Description& description) {
  std::string counts;
  for (const DeviationKind kind : kinds) {
    const auto count = std::ranges::count(description.deviations, kind, &Deviation::kind);
    if (count > 0)
      counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", count, name_of(kind));
  }
  return counts;
}

std::vector<std::string> deviation_lines(const Description& description) {
  std::vector<std::string> lines;
  for (const Deviation& deviation : description.deviations) lines.push_back(line_of(deviation));
  return lines;
}

std::string deviation_summary(const Description& description) {
  if (description.deviations.empty()) return {};
  std::vector<const Deviation*> first;
  for (const Deviation& deviation : description.deviations) first.push_back(&deviation);
  // What is missing is seen at once.
  std::ranges::stable_sort(first, [](const Deviation* a, const Deviation* b) {
    return a->kind == DeviationKind::missing && b->kind != DeviationKind::missing;
  });
  std::string text = "not all is as the file says: " + deviation_counts(description);
  for (size_t i = 0; i < std::min(first.size(), told_in_summary); ++i)
    text += "\n  " + line_of(*first[i]);
  if (first.size() > told_in_summary)
    text += fmt::format("\n  and {} more: kaustik info lists them", first.size() - told_in_summary);
  return text;
}

}  // namespace kaustik
