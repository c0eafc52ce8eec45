#include "kaustik/base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <numeric>

namespace kaustik {
namespace {

/// The line of a file, for the excerpt; empty if it cannot be read or is too long to help.
std::string line_of_file(const std::string& file, int line) {
  std::ifstream in(file);
  std::string text;
  for (int i = 0; i < line && std::getline(in, text); ++i)
    if (i + 1 == line && text.size() <= 400) return text;
  return {};
}

/// Whether it can be printed: no control characters but tabs and carriage returns.
bool is_text(const std::string& line) {
  return std::none_of(line.begin(), line.end(), [](char c) {
    const auto code = static_cast<unsigned char>(c);
    return (code < 0x20 && c != '\t' && c != '\r') || code == 0x7f;
  });
}

/// Who leaves the column out knows of no letter to point at, or must not show what may be any file.
std::string excerpt(const Place& place) {
  const std::string line = line_of_file(*place.file, place.line);
  if (line.empty() || !is_text(line)) return {};
  std::string caret;
  for (int i = 0; i + 1 < place.column && i < int(line.size()); ++i)
    caret += line[size_t(i)] == '\t' ? '\t' : ' ';
  return fmt::format("\n    {}\n    {}^", line, caret);
}

std::string describe(const Problem& problem) {
  std::string text;
  if (problem.place.file) text = text_of(problem.place) + ": ";
  text += problem.message;
  if (problem.place.file && problem.place.column > 0) text += excerpt(problem.place);
  if (!problem.remedy.empty()) text += "\n  remedy: " + problem.remedy;
  return text;
}

/// Without the dependence on the locale, which takes most of the time.
char lower(char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; }

/// Levenshtein distance, letters compared without case; `limit` if it is not below that.
size_t edit_distance(std::string_view a, std::string_view b, size_t limit) {
  if (std::max(a.size(), b.size()) - std::min(a.size(), b.size()) >= limit) return limit;
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 0; i < a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i + 1;
    // What lies farther from the diagonal than the limit cannot be on the way.
    const size_t begin = i + 1 > limit ? i + 1 - limit : 0, end = std::min(b.size(), i + limit);
    if (begin > 0) diagonal = row[begin], row[begin] = limit;
    size_t least = row[begin];
    for (size_t j = begin; j < end; ++j) {
      const size_t above = row[j + 1];
      const bool equal = lower(a[i]) == lower(b[j]);
      row[j + 1] = std::min({diagonal + (equal ? 0 : 1), above + 1, row[j] + 1});
      diagonal = above;
      least = std::min(least, row[j + 1]);
    }
    if (least >= limit) return limit;
  }
  return std::min(row[b.size()], limit);
}

}  // namespace

std::string text_of(const Place& place) {
  if (!place.file) return {};
  std::string text = *place.file;
  if (place.line > 0) text += fmt::format(":{}", place.line);
  if (place.column > 0) text += fmt::format(":{}", place.column);
  return text;
}

std::string keep_one(const Place& first) {
  const std::string text = text_of(first);
  return text.empty() ? "keep one" : fmt::format("keep one; the first is here: {}", text);
}

Error::Error(ErrorKind kind, std::vector<Problem> problems)
    : kind_(kind), problems_(std::move(problems)) {
  for (const Problem& problem : problems_) {
    if (!text_.empty()) text_ += '\n';
    text_ += describe(problem);
  }
}

Error::Error(ErrorKind kind, std::string message, std::string remedy, Place place)
    : Error(kind, std::vector<Problem>{{std::move(message), std::move(remedy), std::move(place)}}) {
}

void Problems::add(std::string message, std::string remedy, Place place) {
  problems_.push_back({std::move(message), std::move(remedy), std::move(place)});
  if (problems_.size() >= maximum) throw_if_any();
}

void Problems::throw_if_any() const {
  if (!problems_.empty()) throw Error(ErrorKind::input, problems_);
}

std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates) {
  std::string best;
  // Of three letters two may not be others.
  size_t best_distance = (name.size() <= 3 ? 1 : std::max<size_t>(2, name.size() / 3)) + 1;
  for (const std::string& candidate : candidates) {
    const size_t distance = edit_distance(name, candidate, best_distance);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

std::string suggest(std::string_view name, const std::vector<std::string>& candidates) {
  if (candidates.empty()) return "there are none to choose from";
  const std::string nearest = nearest_name(name, candidates);
  std::string text;
  if (!nearest.empty()) text = fmt::format("did you mean '{}'? ", nearest);
  return text + fmt::format("Valid: {}", fmt::join(candidates, ", "));
}

}  // namespace kaustik
