#include "kaustik/transport/gauge_disks.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "kaustik/base/parallel.h"
#include "kaustik/transport/visibility.h"

namespace kaustik {
namespace {

constexpr uint32_t disks_in_leaf = 4;
/// Points of a disk that are looked at, and how many more where some are hidden.
constexpr int first_looks = 48, all_looks = 192;

}  // namespace

GaugeDisks::GaugeDisks(const Scene& scene, std::vector<float> radii, float turn, uint64_t& rays)
    : scene_(&scene), radii_(std::move(radii)), inverse_shares_(radii_.size(), {1.0f, 1.0f}) {
  for (uint32_t i = 0; i < radii_.size(); ++i)
    if (radii_[i] > 0 && std::isfinite(radii_[i])) numbers_.push_back(i);
  if (numbers_.empty()) return;
  std::atomic<uint64_t> counted{0};
  parallel_blocks(numbers_.size(), 16, [&](size_t begin, size_t end, size_t) {
    uint64_t of_block = 0;
    for (size_t i = begin; i < end; ++i) {
      const size_t number = numbers_[i];
      inverse_shares_[number] = {1 / share_in_sight(number, radii_[number], turn, of_block),
                                 1 / share_in_sight(number, wide_radius(number), turn, of_block)};
    }
    counted += of_block;
  });
  rays += counted;
  build(0, uint32_t(numbers_.size()));
}

float GaugeDisks::share_in_sight(size_t number, float radius, float turn, uint64_t& rays) const {
  const SurfacePoint& point = gauge(number).point;
  const Frame frame(point.ng);
  int looks = 0, seen = 0;
  const auto look = [&](int count) {
    for (; looks < count; ++looks) {
      // By the weights: their share within ρ radii is 2ρ² − ρ⁴.
      const float u = (float(looks % first_looks) + 0.5f) / first_looks;
      const float distance = radius * std::sqrt(1 - std::sqrt(1 - u));
      const float angle = 2 * pi * std::fmod(float(looks) * 0.61803399f + turn, 1.0f);
      const Vec3f to =
          point.position + (frame.x * std::cos(angle) + frame.y * std::sin(angle)) * distance;
      if (is_unobstructed(*scene_, spawn_ray_to(point, to), rays)) ++seen;
    }
  };
  look(first_looks);
  if (seen < looks) look(all_looks);
  return float(std::max(1, seen)) / float(looks);
}

Bounds3f GaugeDisks::bounds_of(uint32_t number) const {
  const SurfacePoint& point = gauge(number).point;
  const float radius = wide_radius(number);
  Vec3f half;
  for (int axis = 0; axis < 3; ++axis)
    half[axis] = radius * std::sqrt(std::max(0.0f, 1 - sqr(point.ng[axis])));
  // What rounding may leave out.
  half += Vec3f(1e-3f * radius + 8 * float_rounding * max_abs(point.position));
  return {point.position - half, point.position + half};
}

uint32_t GaugeDisks::build(uint32_t begin, uint32_t end) {
  const auto index = uint32_t(nodes_.size());
  nodes_.emplace_back();
  Node node;
  node.begin = begin;
  node.end = end;
  for (uint32_t i = begin; i < end; ++i) node.box.extendBy(bounds_of(numbers_[i]));
  if (end - begin > disks_in_leaf) {
    const int axis = int(node.box.majorAxis());
    const uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(numbers_.begin() + begin, numbers_.begin() + middle, numbers_.begin() + end,
                     [&](uint32_t a, uint32_t b) {
                       const float x = gauge(a).point.position[axis];
                       const float y = gauge(b).point.position[axis];
                       return x != y ? x < y : a < b;
                     });
    build(begin, middle);
    node.second = build(middle, end);
  }
  nodes_[index] = node;
  return index;
}

bool GaugeDisks::meets(const Bounds3f& box, const Ray& ray, float length) {
  float near = 0, far = length;
  for (int axis = 0; axis < 3; ++axis) {
    const float inverse = 1 / ray.direction[axis];
    float a = (box.min[axis] - ray.origin[axis]) * inverse;
    float b = (box.max[axis] - ray.origin[axis]) * inverse;
    if (a > b) std::swap(a, b);
    // What is not a number, of a ray within a side of the box, leaves both as they are.
    near = a > near ? a : near;
    far = b < far ? b : far;
  }
  return near <= far;
}

bool GaugeDisks::crosses(uint32_t number, const Ray& ray, float length, Crossing& at) const {
  const SurfacePoint& point = gauge(number).point;
  const float speed = dot(ray.direction, point.ng);
  if (!(speed < 0)) return false;
  const Vec3f to_gauge = point.position - ray.origin;
  const float distance = dot(to_gauge, point.ng) / speed;
  if (!(distance > 0 && distance < length)) return false;
  const Vec3f offset = ray.direction * distance - to_gauge;
  const float offset_sq = length_sq(offset);
  if (!(offset_sq < sqr(wide_radius(number)))) return false;
  at = {number, distance, point.position + offset, offset_sq};
  return true;
}

}  // namespace kaustik
