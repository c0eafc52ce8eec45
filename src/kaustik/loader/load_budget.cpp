#include "kaustik/loader/load_budget.h"

#include <fmt/format.h>

namespace kaustik::mitsuba {

void LoadBudget::spend(size_t bytes, const Place& place) {
  if (bytes <= allowed_ - spent_) {
    spent_ += bytes;
    return;
  }
  throw Error(ErrorKind::input,
              fmt::format("the scene includes the same files so often, or repeats entities so "
                          "often, that it takes more than {} MiB beyond them",
                          beyond_files >> 20),
              "include each file once and refer to its objects by their ids, or place a "
              "shapegroup with instances",
              place);
}

}  // namespace kaustik::mitsuba
