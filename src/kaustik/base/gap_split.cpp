#include "kaustik/base/gap_split.h"

#include <algorithm>

namespace kaustik {

std::optional<float> split_in_gap(std::vector<float> places, float least_gap) {
  std::sort(places.begin(), places.end());
  const size_t count = places.size(), middle = count / 2;
  const auto is_gap = [&](size_t i) {
    return i >= 1 && i < count && places[i] - places[i - 1] > least_gap;
  };
  for (size_t off = 0; off <= middle; ++off)
    for (const size_t i : {middle - off, middle + off})
      if (is_gap(i)) {
        const float between = places[i - 1] + 0.5f * (places[i] - places[i - 1]);
        // Of two floats that are neighbours there is none between.
        return between > places[i - 1] ? between : places[i];
      }
  return std::nullopt;
}

}  // namespace kaustik
