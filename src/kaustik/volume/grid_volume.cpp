#include "kaustik/volume/grid_volume.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace kaustik {
namespace {

/// The sample that stands for the one of that number, which may lie one beyond the box.
int wrapped_sample(int i, int size, GridVolume::Wrap wrap) {
  if (wrap == GridVolume::Wrap::repeat) return i < 0 ? size - 1 : i < size ? i : 0;
  // The mirror image of the outermost sample is that sample.
  return std::clamp(i, 0, size - 1);
}

}  // namespace

GridVolume::GridVolume(const VolumeSamples& samples, Filter filter, Wrap wrap,
                       const Transform& world_from_unit)
    : filter_(filter),
      wrap_(wrap),
      channels_(samples.channels),
      size_(samples.size),
      margin_(filter == Filter::trilinear ? 0.5f : 0.0f) {
  const Transform unit_from_world = world_from_unit.inverse();
  for (size_t axis = 0; axis < 3; ++axis) {
    cells_[axis] = size_[axis] + (filter == Filter::trilinear ? 1 : 0);
    bricks_along_[axis] = (cells_[axis] + brick_size - 1) >> brick_shift;
    regions_along_[axis] = (cells_[axis] + (1 << region_shift) - 1) >> region_shift;
    sides_[axis] = std::min(brick_size, cells_[axis]) + (filter == Filter::trilinear ? 1 : 0);
    for (int column = 0; column < 4; ++column)
      cells_from_world_[axis][size_t(column)] =
          unit_from_world.at(int(axis), column) * size_[axis] +
          (column == 3 ? double(margin_) : 0.0);
  }
  bricks_.resize(brick_index(0, 0, bricks_along_[2]));
  std::vector<float> block(block_values());
  for (int z = 0; z < bricks_along_[2]; ++z)
    for (int y = 0; y < bricks_along_[1]; ++y)
      for (int x = 0; x < bricks_along_[0]; ++x) {
        fill_brick(samples, wrap, {x, y, z}, block);
        Brick& brick = bricks_[brick_index(x, y, z)];
        brick.value = block.front();
        const bool is_uniform =
            channels_ == 1 && std::all_of(block.begin(), block.end(),
                                          [&](float value) { return value == block.front(); });
        if (is_uniform) continue;
        brick.block = uint32_t(values_.size() / block_values());
        values_.insert(values_.end(), block.begin(), block.end());
      }
  values_.shrink_to_fit();
  if (channels_ == 1) find_bounds();
  const auto [least, largest] = std::minmax_element(samples.values.begin(), samples.values.end());
  least_ = *least;
  largest_ = *largest;
  std::vector<double> sums(size_t(channels_), 0.0);
  for (size_t i = 0; i < samples.values.size(); ++i)
    sums[i % size_t(channels_)] += double(samples.values[i]);
  for (const double sum : sums)
    means_.push_back(float(sum * channels_ / double(samples.values.size())));
  double shortest = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3d edge(world_from_unit.at(0, axis), world_from_unit.at(1, axis),
                     world_from_unit.at(2, axis));
    shortest = std::min(shortest, edge.length() / size_[size_t(axis)]);
  }
  cell_size_ = float(shortest);
}

GridVolume::Bounds GridVolume::bounds_of(const Brick& brick) const {
  if (brick.block == uniform) return {brick.value, brick.value};
  const float* first = values_.data() + size_t(brick.block) * block_values();
  const auto [least, largest] = std::minmax_element(first, first + block_values());
  return {*least, *largest};
}

void GridVolume::find_bounds() {
  constexpr float none = std::numeric_limits<float>::infinity();
  bounds_.assign(region_index(0, 0, regions_along_[2]), {none, -none});
  constexpr int to_region = region_shift - brick_shift;
  size_t brick = 0;
  for (int z = 0; z < bricks_along_[2]; ++z)
    for (int y = 0; y < bricks_along_[1]; ++y)
      for (int x = 0; x < bricks_along_[0]; ++x) {
        const Bounds of_brick = bounds_of(bricks_[brick++]);
        Bounds& bounds = bounds_[region_index(x >> to_region, y >> to_region, z >> to_region)];
        bounds.least = std::min(bounds.least, of_brick.least);
        bounds.largest = std::max(bounds.largest, of_brick.largest);
      }
}

double GridVolume::most_kept_values(const VolumeSamples& samples, Filter filter) {
  const int between = filter == Filter::trilinear ? 1 : 0;
  double count = samples.channels;
  for (const int size : samples.size) {
    const int cells = size + between;
    const int bricks = (cells + brick_size - 1) >> brick_shift;
    count *= double(bricks) * (std::min(brick_size, cells) + between);
  }
  return count;
}

/// With what lies beyond the box, and beyond the last cell whatever is in memory.
void GridVolume::fill_brick(const VolumeSamples& samples, Wrap wrap,
                            const std::array<int, 3>& brick, std::vector<float>& block) const {
  // Between samples −1 and 0 is cell 0, if there is any between them.
  const int first = filter_ == Filter::trilinear ? -1 : 0;
  const auto sample = [&](size_t axis, int i) {
    const int last = size_[axis] + (filter_ == Filter::trilinear ? 0 : -1);
    const int number = std::min((brick[axis] << brick_shift) + i + first, last);
    return size_t(wrapped_sample(number, size_[axis], wrap));
  };
  size_t to = 0;
  for (int z = 0; z < sides_[2]; ++z)
    for (int y = 0; y < sides_[1]; ++y) {
      const size_t row = (sample(2, z) * size_t(size_[1]) + sample(1, y)) * size_t(size_[0]);
      for (int x = 0; x < sides_[0]; ++x)
        for (int c = 0; c < channels_; ++c)
          block[to++] = samples.values[(row + sample(0, x)) * size_t(channels_) + size_t(c)];
    }
}

/// In cells, of a place in the box that looks like this one.
float GridVolume::wrapped(double at, int axis) const {
  const double size = double(size_[size_t(axis)]);
  double inside = at - double(margin_);
  if (!(inside >= 0 && inside <= size)) {
    if (wrap_ == Wrap::repeat) {
      inside -= size * std::floor(inside / size);
    } else if (wrap_ == Wrap::mirror) {
      inside -= 2 * size * std::floor(inside / (2 * size));
      if (inside > size) inside = 2 * size - inside;
    }
    // In this order what is no number becomes one.
    inside = std::min(std::max(0.0, inside), size);
  }
  return float(inside) + margin_;
}

/// The cell that a place in cells is in.
struct GridVolume::Place {
  const Brick* brick;
  int local[3];    ///< number of the cell in its brick
  float share[3];  ///< how far the place is on the way to the next cell
};

GridVolume::Place GridVolume::place_in_cells(const std::array<float, 3>& at) const {
  Place place;
  int brick[3];
  for (size_t axis = 0; axis < 3; ++axis) {
    const int cell = std::clamp(int(at[axis]), 0, cells_[axis] - 1);
    brick[axis] = cell >> brick_shift;
    place.local[axis] = cell & (brick_size - 1);
    place.share[axis] = at[axis] - float(cell);
  }
  place.brick = &bricks_[brick_index(brick[0], brick[1], brick[2])];
  return place;
}

float GridVolume::value_in_cells(const std::array<float, 3>& at, int channel) const {
  const Place place = place_in_cells(at);
  const Brick& in = *place.brick;
  if (in.block == uniform) return in.value;
  const size_t to_x = size_t(channels_), to_y = to_x * size_t(sides_[0]),
               to_z = to_y * size_t(sides_[1]);
  const float* corner = values_.data() + size_t(in.block) * block_values() +
                        size_t(place.local[2]) * to_z + size_t(place.local[1]) * to_y +
                        size_t(place.local[0]) * to_x + size_t(channel);
  if (filter_ == Filter::nearest) return *corner;
  const auto between = [](float a, float b, float t) { return a + (b - a) * t; };
  const auto along_x = [&](const float* from) {
    return between(from[0], from[to_x], place.share[0]);
  };
  const float near = between(along_x(corner), along_x(corner + to_y), place.share[1]);
  const float far = between(along_x(corner + to_z), along_x(corner + to_z + to_y), place.share[1]);
  return between(near, far, place.share[2]);
}

const float* GridVolume::sample_in_cells(const std::array<float, 3>& at, float& u) const {
  assert(channels_ == 1);
  auto [in, local, share] = place_in_cells(at);
  if (in->block == uniform) return &in->value;
  if (filter_ == Filter::trilinear)
    for (int axis = 0; axis < 3; ++axis) {
      const bool is_next = u < share[axis];
      local[axis] += is_next ? 1 : 0;
      u = is_next ? u / share[axis] : (u - share[axis]) / (1 - share[axis]);
    }
  return values_.data() + size_t(in->block) * block_values() +
         size_t((local[2] * sides_[1] + local[1]) * sides_[0] + local[0]);
}

float GridVolume::value(const Vec3f& position, int channel) const {
  assert(channel < channels_);
  std::array<float, 3> at;
  for (int axis = 0; axis < 3; ++axis) at[size_t(axis)] = wrapped(in_cells(position, axis), axis);
  return value_in_cells(at, channel);
}

float GridVolume::inside(const Vec3f& position) const {
  std::array<float, 3> at;
  for (int axis = 0; axis < 3; ++axis) {
    const double cells = in_cells(position, axis);
    const double begin = double(margin_), end = begin + double(size_[size_t(axis)]);
    if (!(cells >= begin && cells <= end)) return 0;
    at[size_t(axis)] = float(cells);
  }
  return value_in_cells(at, 0);
}

std::optional<GridVolume::Separated> GridVolume::separated() const {
  constexpr float tolerance = 1e-4f;  // of the largest value, for what programs have rounded
  if (channels_ != 3 || !(largest_ > 0)) return std::nullopt;
  const auto place = [&](size_t i) {
    return Vec3f(values_[3 * i], values_[3 * i + 1], values_[3 * i + 2]);
  };
  const auto largest_of = [](const Vec3f& v) { return std::max({v.x, v.y, v.z}); };
  Vec3f color(0, 0, 0);
  for (size_t i = 0; i < values_.size() / 3; ++i)
    if (largest_of(place(i)) > largest_of(color)) color = place(i);
  color *= 1 / largest_of(color);
  Separated result{*this, color};
  GridVolume& density = result.density;
  density.channels_ = 1;
  density.values_.resize(values_.size() / 3);
  double sum = 0;
  for (size_t i = 0; i < density.values_.size(); ++i) {
    const float value = largest_of(place(i));
    if (max_abs(place(i) - color * value) > tolerance * largest_) return std::nullopt;
    density.values_[i] = value;
    sum += double(value);
  }
  density.means_ = {float(sum / double(density.values_.size()))};
  density.find_bounds();
  return result;
}

}  // namespace kaustik
