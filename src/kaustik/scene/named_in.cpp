#include "kaustik/scene/named_in.h"

#include <fmt/format.h>

namespace kaustik {

Problem named_in(Problem problem, const Place& place) {
  if (problem.place.file && place.file && *problem.place.file != *place.file)
    problem.message = fmt::format("{} (named in {}:{}:{})", problem.message, *place.file,
                                  place.line, place.column);
  if (!problem.place.file) problem.place = place;
  return problem;
}

}  // namespace kaustik
