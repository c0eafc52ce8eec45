#include "kaustik/photon/emission/direction_cells.h"

#include <algorithm>
#include <cmath>

#include "kaustik/base/to_integer.h"

namespace kaustik {
namespace {

/// Narrows [low, high] to where coefficient · w ≤ bound.
void limit(float coefficient, float bound, float& low, float& high) {
  if (coefficient > 0)
    high = std::min(high, bound / coefficient);
  else if (coefficient < 0)
    low = std::max(low, bound / coefficient);
  else if (bound < 0)
    high = -infinity;
}

float least_abs(float low, float high) { return low > 0 ? low : high < 0 ? -high : 0.0f; }

}  // namespace

DirectionCells::FaceBox DirectionCells::in_face(const Bounds3f& box, int face) {
  const int axis = face / 2, x = (axis + 1) % 3, y = (axis + 2) % 3;
  FaceBox result{{box.min[x], box.min[y]}, {box.max[x], box.max[y]}, box.min[axis], box.max[axis]};
  if (face % 2 == 1) {
    result.near = -box.max[axis];
    result.far = -box.min[axis];
  }
  return result;
}

Vec3f DirectionCells::direction_of(int face, float x, float y) {
  const int axis = face / 2;
  Vec3f d;
  d[axis] = face % 2 == 1 ? -1.0f : 1.0f;
  d[(axis + 1) % 3] = x;
  d[(axis + 2) % 3] = y;
  return d;
}

/// Directions of a face have |x| ≤ w and |y| ≤ w: what of the box can be seen there is at least so
/// far along the axis.
void DirectionCells::widen_window(const FaceBox& box, Window& window) const {
  float near = std::max(box.near, 0.0f);
  for (int axis = 0; axis < 2; ++axis)
    near = std::max(near, least_abs(box.min[axis], box.max[axis]));
  if (!(near <= box.far)) return;
  float low[2] = {-1, -1}, high[2] = {1, 1};
  for (int axis = 0; axis < 2 && near > 0; ++axis) {
    low[axis] = std::max(-1.0f, std::min(box.min[axis] / near, box.min[axis] / box.far));
    high[axis] = std::min(1.0f, std::max(box.max[axis] / near, box.max[axis] / box.far));
    if (!(low[axis] <= high[axis])) return;
  }
  // A little wider, so that the rounding of directions stays inside.
  for (int axis = 0; axis < 2; ++axis) {
    window.min[axis] = std::max(-1.0f, std::min(window.min[axis], low[axis] - 1e-5f));
    window.max[axis] = std::min(1.0f, std::max(window.max[axis], high[axis] + 1e-5f));
  }
}

/// A box is seen through a cell if some w has both u0·w ≤ x ≤ u1·w with x in the box and the same
/// along y: linear in w, so an interval tells exactly.
void DirectionCells::mark(const FaceBox& box, int face) {
  const Window& window = windows_[face];
  for (int y = 0; y < resolution_; ++y) {
    const float y0 = window.min[1] + float(y) * step(face, 1) - 1e-6f;
    const float y1 = window.min[1] + float(y + 1) * step(face, 1) + 1e-6f;
    float row_low = std::max(box.near, 0.0f), row_high = box.far;
    limit(y0, box.max[1], row_low, row_high);
    limit(-y1, -box.min[1], row_low, row_high);
    if (!(row_low <= row_high)) continue;
    for (int x = 0; x < resolution_; ++x) {
      const float x0 = window.min[0] + float(x) * step(face, 0) - 1e-6f;
      const float x1 = window.min[0] + float(x + 1) * step(face, 0) + 1e-6f;
      float low = row_low, high = row_high;
      limit(x0, box.max[0], low, high);
      limit(-x1, -box.min[0], low, high);
      if (low <= high) density_[index(face, x, y)] = 1;
    }
  }
}

DirectionCells::DirectionCells(const std::vector<Bounds3f>& boxes, int resolution)
    : resolution_(resolution), density_(6 * size_t(resolution) * size_t(resolution), 0.0f) {
  for (int face = 0; face < 6; ++face) {
    for (const Bounds3f& box : boxes) widen_window(in_face(box, face), windows_[face]);
    if (windows_[face].empty()) continue;
    for (const Bounds3f& box : boxes) mark(in_face(box, face), face);
  }
}

bool DirectionCells::set_weights(const std::function<double(const Cell&)>& weight) {
  std::vector<double> weights;
  double total = 0;
  occupied_.clear();
  for (int face = 0; face < 6; ++face) {
    if (windows_[face].empty()) continue;
    const float dx = step(face, 0), dy = step(face, 1);
    for (int y = 0; y < resolution_; ++y)
      for (int x = 0; x < resolution_; ++x) {
        float& density = density_[index(face, x, y)];
        if (!(density > 0)) continue;
        const float left = windows_[face].min[0] + float(x) * dx;
        const float low = windows_[face].min[1] + float(y) * dy;
        const Vec3f middle = direction_of(face, left + 0.5f * dx, low + 0.5f * dy);
        Cell cell;
        cell.center = normalize(middle);
        for (int corner = 0; corner < 4; ++corner)
          cell.cos_radius =
              std::min(cell.cos_radius,
                       dot(cell.center, normalize(direction_of(face, left + float(corner % 2) * dx,
                                                               low + float(corner / 2) * dy))));
        const float distance_sq = length_sq(middle);
        cell.solid_angle = dx * dy / (distance_sq * std::sqrt(distance_sq));
        const double w = weight(cell);
        density = 0;
        if (!(w > 0)) continue;
        occupied_.push_back(uint32_t(index(face, x, y)));
        weights.push_back(w);
        total += w;
      }
  }
  // Differences of the rounded sums are what is sampled, so the densities follow them.
  cumulative_.clear();
  double sum = 0;
  for (size_t i = 0; i < weights.size(); ++i) {
    const float before = i > 0 ? cumulative_.back() : 0.0f;
    cumulative_.push_back(i + 1 < weights.size() ? float((sum += weights[i]) / total) : 1.0f);
    const int face = int(occupied_[i] / uint32_t(resolution_ * resolution_));
    density_[occupied_[i]] = (cumulative_.back() - before) / (step(face, 0) * step(face, 1));
  }
  return !weights.empty();
}

Vec3f DirectionCells::sample(float u_cell, const Vec2f& u) const {
  const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), u_cell);
  const size_t i = std::min(size_t(found - cumulative_.begin()), cumulative_.size() - 1);
  const int n = resolution_, cell = int(occupied_[i]);
  const int face = cell / (n * n), y = cell / n % n, x = cell % n;
  return normalize(direction_of(face, windows_[face].min[0] + (float(x) + u.x) * step(face, 0),
                                windows_[face].min[1] + (float(y) + u.y) * step(face, 1)));
}

float DirectionCells::pdf(const Vec3f& direction) const {
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (std::fabs(direction[k]) > std::fabs(direction[axis])) axis = k;
  const int face = 2 * axis + (direction[axis] < 0 ? 1 : 0);
  const Window& window = windows_[face];
  if (window.empty()) return 0;
  const float w = std::fabs(direction[axis]);
  int cell[2];
  for (int k = 0; k < 2; ++k) {
    const float place = direction[(axis + 1 + k) % 3] / w - window.min[k];
    const float along = place / step(face, k);
    if (!(along >= 0 && along <= float(resolution_))) return 0;
    cell[k] = to_integer(along, 0, resolution_ - 1);
  }
  // Solid angle over area of the face: w³ for a unit direction.
  return density_[index(face, cell[0], cell[1])] / (w * w * w);
}

}  // namespace kaustik
