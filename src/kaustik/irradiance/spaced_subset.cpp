#include "kaustik/irradiance/spaced_subset.h"

#include "kaustik/base/sampler.h"
#include "kaustik/base/to_integer.h"

namespace kaustik {
namespace {

/// The face of a cube that the direction goes through.
int cube_face(const Vec3f& v) {
  int axis = 0;
  for (int i = 1; i < 3; ++i)
    if (std::fabs(v[i]) > std::fabs(v[axis])) axis = i;
  return 2 * axis + (v[axis] < 0 ? 1 : 0);
}

uint64_t cell_key(int class_of_points, const int64_t (&cell)[3]) {
  uint64_t key = uint64_t(int64_t(class_of_points));
  for (const int64_t coordinate : cell) key = hash_mix(key, uint64_t(coordinate));
  return key;
}

int64_t cell_coordinate(float position, float cell_size) {
  constexpr int64_t last = 1'000'000'000'000'000;
  return to_integer(std::floor(double(position) / double(cell_size)), -last, last);
}

}  // namespace

bool SpacedSubset::pick(const Vec3f& position, const Vec3f& normal, float spacing) {
  int exponent;
  std::frexp(spacing, &exponent);
  const float cell_size = std::ldexp(2.0f, exponent);  // > 2 spacing: at most 8 cells are near
  const int points_class = exponent * 6 + cube_face(normal);
  int64_t low[3], high[3], own[3];
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = cell_coordinate(position[axis] - spacing, cell_size);
    high[axis] = cell_coordinate(position[axis] + spacing, cell_size);
    own[axis] = cell_coordinate(position[axis], cell_size);
  }
  int64_t cell[3];
  for (cell[0] = low[0]; cell[0] <= high[0]; ++cell[0])
    for (cell[1] = low[1]; cell[1] <= high[1]; ++cell[1])
      for (cell[2] = low[2]; cell[2] <= high[2]; ++cell[2]) {
        const auto found = first_in_cell_.find(cell_key(points_class, cell));
        if (found == first_in_cell_.end()) continue;
        for (uint32_t i = found->second; i != none; i = picked_[i].next)
          if (length_sq(picked_[i].position - position) < sqr(spacing)) return false;
      }
  const auto [slot, is_new] = first_in_cell_.try_emplace(cell_key(points_class, own), none);
  picked_.push_back({position, slot->second});
  slot->second = uint32_t(picked_.size() - 1);
  return true;
}

}  // namespace kaustik
