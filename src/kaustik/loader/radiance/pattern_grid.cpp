#include "kaustik/loader/radiance/pattern_grid.h"

#include <algorithm>
#include <cmath>

#include "kaustik/base/array.h"
#include "kaustik/loader/radiance/cal_program.h"

namespace kaustik::radiance {

PatternGrid::PatternGrid(std::vector<std::shared_ptr<const Pattern>> patterns, const Rgb& colour,
                         const Place& place)
    : patterns_(std::move(patterns)),
      colour_(colour),
      texture_(make_object("texture", "volume", place)),
      volume_(make_object("volume", "gridvolume", place)) {
  nest(*texture_, volume_, "volume");
}

void PatternGrid::extend(const Vec3d& position, const Vec3d& normal) {
  for (int axis = 0; axis < 3; ++axis) {
    low_[axis] = is_empty_ ? position[axis] : std::min(low_[axis], position[axis]);
    high_[axis] = is_empty_ ? position[axis] : std::max(high_[axis], position[axis]);
  }
  if (is_empty_) normal_ = normal;
  is_empty_ = false;
}

bool PatternGrid::fill(size_t most_samples) {
  const double largest = std::max({high_.x - low_.x, high_.y - low_.y, high_.z - low_.z, 1e-6});
  // Flat boxes get what thickness rounding asks for, and one layer of samples.
  Vec3d extent;
  for (int axis = 0; axis < 3; ++axis)
    extent[axis] = std::max(high_[axis] - low_[axis], 1e-4 * largest);
  size_t counts[3] = {1, 1, 1};
  const auto total = [&] { return counts[0] * counts[1] * counts[2]; };
  double spacing = largest;
  for (double next = largest; next > largest / 1024; next /= 1.1) {
    size_t previous[3] = {counts[0], counts[1], counts[2]};
    for (int axis = 0; axis < 3; ++axis)
      counts[axis] = std::max<size_t>(1, size_t(std::lround(extent[axis] / next)));
    if (total() > most_samples) {
      std::copy(previous, previous + 3, counts);
      break;
    }
    spacing = next;
  }
  spacing_ = spacing;
  const Vec3d corner = (low_ + high_) * 0.5 - extent * 0.5;
  std::vector<float> values;
  values.reserve(3 * total());
  bool is_whole = true;
  PatternPoint point;
  point.normal = normal_;
  point.direction = -normal_;
  for (size_t z = 0; z < counts[2]; ++z)
    for (size_t y = 0; y < counts[1]; ++y)
      for (size_t x = 0; x < counts[0]; ++x) {
        const size_t at[3] = {x, y, z};
        for (int axis = 0; axis < 3; ++axis)
          point.position[axis] =
              corner[axis] + extent[axis] * (double(at[axis]) + 0.5) / double(counts[axis]);
        Rgb colour = colour_;
        try {
          for (const auto& pattern : patterns_) {
            const Rgb factor = pattern->at(point);
            colour = {colour.r * factor.r, colour.g * factor.g, colour.b * factor.b};
          }
        } catch (const CalError&) {
          is_whole = false;
          colour = {0, 0, 0};
        }
        for (const double value : {colour.r, colour.g, colour.b})
          values.push_back(float(std::clamp(value, 0.0, 1.0)));
      }
  give(*volume_, "data", Array::of<float>({counts[2], counts[1], counts[0], 3}, std::move(values)));
  give(*volume_, "to_world", Transform::translate(corner) * Transform::scale(extent));
  return is_whole;
}

}  // namespace kaustik::radiance
