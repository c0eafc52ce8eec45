#include "kaustik/loader/deviations.h"

#include <fmt/format.h>

#include <utility>

#include "kaustik/base/error.h"

namespace kaustik {

void Deviations::add(DeviationKind kind, std::string object, std::string what, Place place,
                     std::string remedy) {
  if (known_.insert({kind, object, what}).second)
    all_.push_back(
        {{kind, std::move(object), std::move(what), std::move(place)}, std::move(remedy)});
}

void Deviations::finish(Description& description, bool is_strict) {
  if (is_strict && !all_.empty()) {
    std::vector<Problem> problems;
    for (const Told& told : all_)
      problems.push_back({fmt::format("{} ({})", told.deviation.what, told.deviation.object),
                          told.remedy.empty()
                              ? "read it without being strict to render what can be rendered"
                              : told.remedy,
                          told.deviation.place});
    throw Error(ErrorKind::input, std::move(problems));
  }
  for (Told& told : all_) {
    if (!told.remedy.empty()) told.deviation.what += "; " + told.remedy;
    description.deviations.push_back(std::move(told.deviation));
  }
  all_.clear();
  known_.clear();
}

}  // namespace kaustik
