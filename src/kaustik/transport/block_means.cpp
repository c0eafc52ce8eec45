#include "kaustik/transport/block_means.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "kaustik/base/parallel.h"

namespace kaustik {
namespace {

constexpr size_t rows_at_once = 16;

}  // namespace

std::vector<double> means_around(const std::vector<double>& values, const Vec2i& blocks,
                                 int reach) {
  const auto width = size_t(blocks.x), height = size_t(blocks.y);
  const auto ends = [reach](size_t i, size_t count) {
    const auto far = size_t(reach);
    return std::pair(i - std::min(i, far), i + std::min(count - 1 - i, far) + 1);
  };
  std::vector<double> along_rows(values.size()), result(values.size());
  parallel_blocks(height, rows_at_once, [&](size_t begin, size_t end, size_t) {
    for (size_t y = begin; y < end; ++y)
      for (size_t x = 0; x < width; ++x) {
        const auto [first, last] = ends(x, width);
        double sum = 0;
        for (size_t k = first; k < last; ++k) sum += values[y * width + k];
        along_rows[y * width + x] = sum / double(last - first);
      }
  });
  parallel_blocks(height, rows_at_once, [&](size_t begin, size_t end, size_t) {
    for (size_t y = begin; y < end; ++y) {
      const auto [first, last] = ends(y, height);
      double* const to = result.data() + y * width;
      for (size_t k = first; k < last; ++k)
        for (size_t x = 0; x < width; ++x) to[x] += along_rows[k * width + x];
      for (size_t x = 0; x < width; ++x) to[x] /= double(last - first);
    }
  });
  return result;
}

void clip_outliers(std::vector<double>& values, double outliers) {
  std::vector<double> sorted = values;
  const auto largest = sorted.begin() + std::ptrdiff_t((1 - outliers) * double(values.size() - 1));
  std::nth_element(sorted.begin(), largest, sorted.end());
  for (double& value : values) value = std::min(value, *largest);
}

}  // namespace kaustik
