#include "kaustik/scene/named_in.h"

#include <fmt/format.h>

namespace kaustik {
namespace {

/// The same file, or within the same object of a program, whose places are the way that leads to
/// them: "floor", "floor.bsdf".
bool is_within(const Place& place, const Place& other) {
  return *place.file == *other.file ||
         (other.line == 0 && place.file->starts_with(*other.file + "."));
}

}  // namespace

Problem named_in(Problem problem, const Place& place) {
  if (problem.place.file && place.file && !is_within(problem.place, place))
    problem.message = fmt::format("{} (named in {})", problem.message, text_of(place));
  if (!problem.place.file) problem.place = place;
  return problem;
}

}  // namespace kaustik
