#include "kaustik/loader/deviations.h"

#include <fmt/format.h>

#include <utility>

#include "kaustik/base/error.h"

namespace kaustik {

void Deviations::add(DeviationKind kind, std::string object, std::string what, Place place) {
  if (known_.insert({kind, object, what}).second)
    all_.push_back({kind, std::move(object), std::move(what), std::move(place)});
}

void Deviations::finish(Description& description, bool is_strict) {
  if (is_strict && !all_.empty()) {
    std::vector<Problem> problems;
    for (const Deviation& deviation : all_)
      problems.push_back({fmt::format("{} ({})", deviation.what, deviation.object),
                          "read it without being strict to render what can be rendered",
                          deviation.place});
    throw Error(ErrorKind::input, std::move(problems));
  }
  for (Deviation& deviation : all_) description.deviations.push_back(std::move(deviation));
  all_.clear();
  known_.clear();
}

}  // namespace kaustik
