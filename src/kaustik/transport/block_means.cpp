#include "kaustik/transport/block_means.h"

#include <algorithm>
#include <cstddef>

namespace kaustik {

std::vector<double> means_around(const std::vector<double>& values, const Vec2i& blocks,
                                 int reach) {
  // Along the rows, then along the columns.
  const auto sweep = [&](const std::vector<double>& from, bool across) {
    std::vector<double> result(from.size());
    const int length = across ? blocks.x : blocks.y, lines = across ? blocks.y : blocks.x;
    const auto at = [&](int line, int i) {
      return across ? size_t(line) * size_t(blocks.x) + size_t(i)
                    : size_t(i) * size_t(blocks.x) + size_t(line);
    };
    for (int line = 0; line < lines; ++line)
      for (int i = 0; i < length; ++i) {
        const int first = std::max(0, i - reach), last = std::min(length - 1, i + reach);
        double sum = 0;
        for (int k = first; k <= last; ++k) sum += from[at(line, k)];
        result[at(line, i)] = sum / double(last - first + 1);
      }
    return result;
  };
  return sweep(sweep(values, true), false);
}

void clip_outliers(std::vector<double>& values, double outliers) {
  std::vector<double> sorted = values;
  const auto largest = sorted.begin() + std::ptrdiff_t((1 - outliers) * double(values.size() - 1));
  std::nth_element(sorted.begin(), largest, sorted.end());
  for (double& value : values) value = std::min(value, *largest);
}

}  // namespace kaustik
