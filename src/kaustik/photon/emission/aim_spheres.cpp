#include "kaustik/photon/emission/aim_spheres.h"

#include <algorithm>
#include <queue>

namespace kaustik {
namespace {

using Targets = std::vector<AimTarget>;

float sphere_radius(const AimTarget& t) {
  const float of_box = bounding_radius(t.box);
  return t.radius > 0 ? std::min(t.radius, of_box) : of_box;
}

/// A run of neighbouring targets that may become one.
struct Cluster {
  size_t begin = 0, end = 0;
  Bounds3f box;
  double weight = 0;  ///< mean, by the squared radii

  double cost() const { return weight * sqr(bounding_radius(box)); }
  /// The costliest first; ties by place so that the order is always the same.
  friend bool operator<(const Cluster& a, const Cluster& b) {
    const bool a_splits = a.end - a.begin > 1, b_splits = b.end - b.begin > 1;
    if (a_splits != b_splits) return b_splits;
    if (a.cost() != b.cost()) return a.cost() < b.cost();
    return a.begin > b.begin;
  }
};

Cluster make_cluster(const Targets& targets, size_t begin, size_t end) {
  Cluster c{begin, end, {}, 0};
  double total = 0;
  for (size_t i = begin; i < end; ++i) {
    c.box.extendBy(targets[i].box);
    const double size = std::max(double(sqr(sphere_radius(targets[i]))), 1e-30);
    c.weight += size * double(targets[i].weight);
    total += size;
  }
  c.weight /= total;
  return c;
}

/// Where to cut the sorted run so that the spheres around both parts are small.
size_t best_cut(const Targets& targets, const Cluster& c) {
  const size_t n = c.end - c.begin;
  std::vector<double> upper(n);
  Bounds3f box;
  for (size_t i = n; i-- > 1;) {
    box.extendBy(targets[c.begin + i].box);
    upper[i] = double(sqr(bounding_radius(box))) * double(n - i);
  }
  box.makeEmpty();
  size_t best = n / 2;
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 1; i < n; ++i) {
    box.extendBy(targets[c.begin + i - 1].box);
    const double cost = double(sqr(bounding_radius(box))) * double(i) + upper[i];
    if (cost < least) least = cost, best = i;
  }
  return c.begin + best;
}

/// Sorts the run along its longest axis and cuts it in two.
size_t split(Targets& targets, const Cluster& c) {
  Bounds3f centers;
  for (size_t i = c.begin; i < c.end; ++i) centers.extendBy(center(targets[i].box));
  const int axis = int(centers.majorAxis());
  std::stable_sort(targets.begin() + std::ptrdiff_t(c.begin),
                   targets.begin() + std::ptrdiff_t(c.end),
                   [axis](const AimTarget& a, const AimTarget& b) {
                     return a.box.min[axis] + a.box.max[axis] < b.box.min[axis] + b.box.max[axis];
                   });
  return best_cut(targets, c);
}

}  // namespace

Targets merge_targets(Targets targets, size_t limit) {
  std::erase_if(targets, [](const AimTarget& t) { return t.box.isEmpty() || !(t.weight > 0); });
  if (targets.size() <= limit) return targets;
  std::priority_queue<Cluster> clusters;
  clusters.push(make_cluster(targets, 0, targets.size()));
  while (clusters.size() < limit) {
    const Cluster c = clusters.top();
    if (c.end - c.begin < 2) break;
    clusters.pop();
    const size_t cut = split(targets, c);
    clusters.push(make_cluster(targets, c.begin, cut));
    clusters.push(make_cluster(targets, cut, c.end));
  }
  Targets merged;
  for (; !clusters.empty(); clusters.pop()) {
    const Cluster& c = clusters.top();
    const bool single = c.end - c.begin == 1;
    merged.push_back(single ? targets[c.begin] : AimTarget{c.box, float(c.weight)});
  }
  return merged;
}

AimSphere bounding_sphere(const AimTarget& target, const Bounds3f& scene_bounds) {
  float coordinates = std::max(max_abs(target.box.min), max_abs(target.box.max));
  if (!scene_bounds.isEmpty())
    coordinates = std::max({coordinates, max_abs(scene_bounds.min), max_abs(scene_bounds.max)});
  const float rounding = 1e-6f * coordinates;
  return {center(target.box), sphere_radius(target) * (1.0f + 1e-5f) + rounding, target.weight};
}

Ball find_ball(const Shape& shape) {
  if (shape.mesh() || !shape.can_sample()) return {};
  const Bounds3f box = shape.bounds();
  if (box.isEmpty()) return {};
  const Vec3f size = box.max - box.min;
  const float radius = 0.5f * size.x;
  const Vec3f middle = center(box);
  const float tolerance = 1e-4f * radius + 1e-6f * max_abs(middle);
  // A surface as large as the whole sphere that lies on the sphere is the sphere.
  if (std::fabs(size.y - size.x) > tolerance || std::fabs(size.z - size.x) > tolerance ||
      std::fabs(shape.area() - 4.0f * pi * sqr(radius)) > 1e-3f * shape.area())
    return {};
  constexpr int steps = 8;
  for (int i = 0; i < steps * steps; ++i) {
    const Vec2f u((float(i % steps) + 0.5f) / steps, (float(i / steps) + 0.5f) / steps);
    const SurfacePoint p = shape.sample_area(u).point;
    const Vec3f outward = p.position - middle;
    if (std::fabs(length(outward) - radius) > tolerance || !(dot(outward, p.ng) > 0.999f * radius))
      return {};
  }
  return {middle, radius};
}

}  // namespace kaustik
