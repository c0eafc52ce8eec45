// What photons are aimed at: boxes of the shapes that a map needs photons from.

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "kaustik/base/sampler.h"
#include "kaustik/base/to_integer.h"
#include "kaustik/base/warp.h"
#include "kaustik/photon/emission/aim_spheres.h"

namespace kaustik {
namespace {

/// A shape where it stands in the world; shapes of groups occur once per instance.
struct PlacedShape {
  const Shape* shape = nullptr;
  const Transform* world_from_shape = nullptr;  ///< null: the identity
  float weight = 0;
  float radius = 0;  ///< in the shape's space, about the centre of its bounds; zero: unknown
};

float mean_albedo(const Bsdf& bsdf, Lobes lobes) {
  const Vec3f wo(std::sqrt(0.5f), 0.0f, std::sqrt(0.5f));
  const float albedo = bsdf.albedo(BsdfContext(), wo, lobes).max_lane();
  return std::isfinite(albedo) ? std::max(albedo, 0.02f) : 0.02f;
}

/// Lengths grow by this factor; zero where it is not the same for all.
float similarity_scale(const Transform& t) {
  const Vec3f x = t.vector({1, 0, 0}), y = t.vector({0, 1, 0}), z = t.vector({0, 0, 1});
  const float size = length_sq(x), tolerance = 1e-4f * size;
  const bool same = std::fabs(length_sq(y) - size) < tolerance &&
                    std::fabs(length_sq(z) - size) < tolerance && abs_dot(x, y) < tolerance &&
                    abs_dot(y, z) < tolerance && abs_dot(z, x) < tolerance;
  return same ? 1.001f * std::sqrt(size) : 0.0f;
}

/// A radius about the centre of its bounds that holds the whole shape; zero if that of the box is
/// all that is known.
float radius_of_shape(const Shape& shape) {
  const Vec3f middle = center(shape.bounds());
  if (const TriangleMesh* mesh = shape.mesh()) {
    float radius_sq = 0;
    for (const Vec3f& p : mesh->positions) radius_sq = std::max(radius_sq, length_sq(p - middle));
    return std::sqrt(radius_sq) * (1.0f + 1e-5f);
  }
  const Ball ball = find_ball(shape);
  return ball.radius * (1.0f + 1e-4f);
}

/// The shape in at most about `count` boxes.
std::vector<AimTarget> boxes_of(const PlacedShape& placed, int count) {
  std::vector<AimTarget> targets;
  for (const Bounds3f& box : placed.shape->bounding_boxes(count))
    if (!box.isEmpty()) targets.push_back({box, placed.weight, 0});
  if (targets.size() <= 1) targets = {{placed.shape->bounds(), placed.weight, placed.radius}};
  if (const Transform* t = placed.world_from_shape) {
    const float scale = similarity_scale(*t);
    for (AimTarget& target : targets) {
      target.box = t->bounds(target.box);
      target.radius *= scale;
    }
  }
  return targets;
}

/// How much the flux of photons would vary that are spread over the spheres as seen from far away,
/// among those that meet the shape: Σ r² over the number of spheres that hold a point, over points
/// of the `points` boxes.
double spread(const std::vector<AimTarget>& targets, const std::vector<AimTarget>& points) {
  double area = 0;
  std::vector<AimSphere> spheres;
  for (const AimTarget& t : targets) {
    spheres.push_back(bounding_sphere(t, {}));
    area += double(sqr(spheres.back().radius));
  }
  double inverse_counts = 0, weights = 0;
  for (size_t k = 0; k < points.size(); ++k) {
    Sampler sampler = Sampler::of(Quadrature::aim_box, uint32_t(k));
    const Vec2f u = sampler.next_2d(), v = sampler.next_2d();
    const Bounds3f& box = points[k].box;
    const Vec3f size = box.max - box.min;
    const Vec3f point = box.min + Vec3f(size.x * u.x, size.y * u.y, size.z * v.x);
    const Vec3f direction = square_to_sphere(sampler.next_2d());
    int count = 0;
    for (const AimSphere& s : spheres)
      count += length_sq(cross(s.center - point, direction)) <= sqr(s.radius);
    const double weight = double(surface_area(box)) + 1e-30;
    inverse_counts += weight / std::max(1, count);
    weights += weight;
  }
  return weights > 0 ? area * inverse_counts / weights : 0.0;
}

/// The shape in as many boxes, up to `share`, as serve aiming best.
std::vector<AimTarget> best_boxes(const PlacedShape& placed, int share) {
  std::vector<AimTarget> best = boxes_of(placed, 1);
  if (share < 2) return best;
  const std::vector<AimTarget> points = boxes_of(placed, 256);
  // What one more sphere costs beside the tracing of a photon.
  const auto cost = [&](const std::vector<AimTarget>& targets) {
    return spread(targets, points) * (1.0 + double(targets.size()) / 500.0);
  };
  double least = 0.9 * cost(best);
  for (int count = 2; count <= share; count *= 2) {
    std::vector<AimTarget> targets = merge_targets(boxes_of(placed, count), size_t(share));
    const double c = cost(targets);
    if (c >= least) continue;
    least = c;
    best = std::move(targets);
  }
  return best;
}

/// All instances of a shape share its radius, which takes a look at every vertex.
void find_radii(std::vector<PlacedShape>& placed) {
  std::unordered_map<const Shape*, float> radii;
  for (PlacedShape& p : placed) {
    const auto [entry, is_new] = radii.try_emplace(p.shape, 0.0f);
    if (is_new) entry->second = radius_of_shape(*p.shape);
    p.radius = entry->second;
  }
}

void add_if_wanted(const Scene& scene, size_t index, Lobes lobes, const Transform* transform,
                   std::vector<PlacedShape>& placed) {
  const Bsdf& bsdf = *scene.surface(uint32_t(index)).bsdf;
  const Shape& shape = scene.tracer().shape(uint32_t(index));
  if (!any(bsdf.traits().lobes & lobes) || shape.bounds().isEmpty()) return;
  placed.push_back({&shape, transform, mean_albedo(bsdf, lobes), 0});
}

std::vector<PlacedShape> placed_shapes(const Scene& scene, Lobes lobes) {
  std::vector<PlacedShape> placed;
  const Geometry& geometry = scene.tracer().geometry();
  for (size_t i = 0; i < geometry.shapes.size(); ++i)
    add_if_wanted(scene, i, lobes, nullptr, placed);
  std::vector<size_t> first_of_group;
  size_t next = geometry.shapes.size();
  for (const auto& group : geometry.groups) {
    first_of_group.push_back(next);
    next += group.size();
  }
  for (const Instance& instance : geometry.instances)
    for (size_t i = 0; i < geometry.groups[instance.group].size(); ++i)
      add_if_wanted(scene, first_of_group[instance.group] + i, lobes, &instance.world_from_group,
                    placed);
  find_radii(placed);
  return placed;
}

}  // namespace

std::vector<AimTarget> find_targets(const Scene& scene, Lobes lobes, int budget, Aim aim) {
  const std::vector<PlacedShape> placed = placed_shapes(scene, lobes);
  const auto limit = size_t(std::max(1, budget));
  std::vector<double> sizes;
  double total = 0;
  for (const PlacedShape& p : placed) {
    const Bounds3f box = p.shape->bounds();
    const Bounds3f in_world = p.world_from_shape ? p.world_from_shape->bounds(box) : box;
    sizes.push_back(double(p.weight * sqr(bounding_radius(in_world))));
    total += sizes.back();
  }
  const double spare = limit > placed.size() ? double(limit - placed.size()) : 0.0;
  std::vector<AimTarget> targets;
  for (size_t i = 0; i < placed.size(); ++i) {
    const int share = 1 + (total > 0 ? to_integer(spare * sizes[i] / total, 0, int(limit)) : 0);
    const std::vector<AimTarget> boxes =
        aim == Aim::boxes ? best_boxes(placed[i], share) : boxes_of(placed[i], share);
    targets.insert(targets.end(), boxes.begin(), boxes.end());
  }
  return merge_targets(std::move(targets), limit);
}

}  // namespace kaustik
