#include "kaustik/loader/closed_mesh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <utility>
#include <vector>

namespace kaustik {
namespace {

/// For each vertex the first one at its place.
std::vector<uint32_t> welded(const Array& positions) {
  const auto* numbers = reinterpret_cast<const float*>(positions.bytes().data());
  const size_t count = positions.count() / 3;
  const auto key = [&](uint32_t vertex) {
    std::array<uint32_t, 3> place;
    for (size_t k = 0; k < 3; ++k)  // −0 is 0
      place[k] = std::bit_cast<uint32_t>(numbers[3 * size_t(vertex) + k] + 0.0f);
    return place;
  };
  std::vector<uint32_t> order(count), first(count);
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    const auto of_a = key(a), of_b = key(b);
    return of_a != of_b ? of_a < of_b : a < b;
  });
  for (size_t i = 0; i < count; ++i)
    first[order[i]] = i > 0 && key(order[i - 1]) == key(order[i]) ? first[order[i - 1]] : order[i];
  return first;
}

}  // namespace

bool is_closed(const Array& positions, const Array& faces) {
  const std::vector<uint32_t> vertex = welded(positions);
  struct Edge {
    uint32_t low, high;
    bool is_upward;
  };
  std::vector<Edge> edges;
  edges.reserve(faces.count());
  const bool is_in_range = faces.visit([&](auto values) {
    for (size_t i = 0; i + 2 < values.size(); i += 3) {
      uint32_t corners[3];
      for (size_t k = 0; k < 3; ++k) {
        if (!(double(values[i + k]) >= 0 && double(values[i + k]) < double(vertex.size())))
          return false;
        corners[k] = vertex[size_t(values[i + k])];
      }
      if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0])
        continue;
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t a = corners[k], b = corners[(k + 1) % 3];
        edges.push_back({std::min(a, b), std::max(a, b), a < b});
      }
    }
    return true;
  });
  if (!is_in_range || edges.empty()) return false;
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::pair(a.low, a.high) < std::pair(b.low, b.high);
  });
  for (size_t i = 0; i < edges.size();) {
    size_t end = i, upward = 0;
    for (; end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high;
         ++end)
      upward += edges[end].is_upward ? 1 : 0;
    if (upward * 2 != end - i) return false;
    i = end;
  }
  return true;
}

}  // namespace kaustik
