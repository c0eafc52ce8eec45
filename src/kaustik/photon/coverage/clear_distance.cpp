#include "kaustik/photon/coverage/clear_distance.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace kaustik {
namespace {

/// Pieces that are looked at; where there are more nothing is said to be clear.
constexpr int most_pieces = 2048;

/// A convex polygon that is cut by planes, each of which adds a corner at most.
class Polygon {
 public:
  explicit Polygon(const std::array<Vec3f, 8>& triangle) : count_(3) {
    std::copy_n(triangle.begin(), 3, corners_.begin());
  }

  /// Leaves what has dot(q, normal) ≥ least. Rounding may bend a sliver so that it has more corners
  /// than there is room for: then it counts as if it were at the origin.
  void cut(const Vec3f& normal, float least) {
    std::array<Vec3f, most> left;
    size_t count = 0;
    for (size_t i = 0; i < count_; ++i) {
      if (count + 2 > most) {
        is_bent_ = true;
        return;
      }
      const Vec3f &a = corners_[i], &b = corners_[(i + 1) % count_];
      const float over_a = dot(a, normal) - least, over_b = dot(b, normal) - least;
      if (over_a >= 0) left[count++] = a;
      if ((over_a >= 0) != (over_b >= 0))
        left[count++] = a + (b - a) * (over_a / (over_a - over_b));
    }
    corners_ = left;
    count_ = count;
  }

  bool is_empty() const { return count_ == 0; }
  /// Of the origin from the polygon's image in the plane of x and y, which have the length 1.
  float distance(const Vec3f& x, const Vec3f& y) const {
    if (is_bent_) return 0;
    float nearest = infinity;
    bool left = true, right = true;
    for (size_t i = 0; i < count_; ++i) {
      const Vec3f &from = corners_[i], &to = corners_[(i + 1) % count_];
      const Vec2f a(dot(from, x), dot(from, y)), b(dot(to, x), dot(to, y));
      const Vec2f way = b - a;
      const float length_sq = way.x * way.x + way.y * way.y;
      const float t =
          length_sq > 0 ? std::clamp(-(a.x * way.x + a.y * way.y) / length_sq, 0.0f, 1.0f) : 0.0f;
      nearest = std::min(nearest, std::hypot(a.x + t * way.x, a.y + t * way.y));
      const float side = a.x * way.y - a.y * way.x;
      left = left && side > 0;
      right = right && side < 0;
    }
    return left || right ? 0.0f : nearest;
  }

 private:
  static constexpr size_t most = 2 * (3 + 2 + DiskEdges::most);
  std::array<Vec3f, most> corners_;
  size_t count_;
  bool is_bent_ = false;
};

class Search {
 public:
  Search(const SpaceOverPlane& space, const DiskEdges& edges, float reach)
      : space_(space), edges_(edges), frame_(space.normal), clear_(reach) {}

  bool take(const SurfacePiece& piece) {
    if (++pieces_ > most_pieces) clear_ = 0;
    if (clear_ > 0) clear_ = std::min(clear_, piece.is_box ? of_box(piece) : of_triangle(piece));
    return clear_ > 0;
  }
  float clear() const { return clear_; }

 private:
  float of_triangle(const SurfacePiece& piece) const {
    std::array<Vec3f, 8> corners = piece.corners;
    for (Vec3f& corner : corners) corner -= space_.origin;
    Polygon polygon(corners);
    polygon.cut(space_.normal, space_.lowest);
    if (!polygon.is_empty()) polygon.cut(-space_.normal, -space_.highest);
    for (size_t i = 0; i < edges_.count && !polygon.is_empty(); ++i)
      polygon.cut(edges_.edges[i].inward, space_.lowest - edges_.edges[i].distance);
    return polygon.is_empty() ? float(infinity) : polygon.distance(frame_.x, frame_.y);
  }
  /// What the shape looks like within is not known.
  float of_box(const SurfacePiece& piece) const {
    float lowest = infinity, highest = -infinity;
    Bounds3f box;
    std::array<float, DiskEdges::most> nearest;
    nearest.fill(-infinity);
    for (const Vec3f& corner : piece.corners) {
      const Vec3f offset = corner - space_.origin;
      lowest = std::min(lowest, dot(offset, space_.normal));
      highest = std::max(highest, dot(offset, space_.normal));
      box.extendBy(offset);
      for (size_t i = 0; i < edges_.count; ++i)
        nearest[i] = std::max(nearest[i], dot(offset, edges_.edges[i].inward));
    }
    if (highest <= space_.lowest || lowest >= space_.highest) return infinity;
    for (size_t i = 0; i < edges_.count; ++i)
      if (nearest[i] <= space_.lowest - edges_.edges[i].distance) return infinity;
    float distance_sq = -sqr(space_.highest);  // of what lies highest, along the plane
    for (int axis = 0; axis < 3; ++axis)
      distance_sq += sqr(std::max({0.0f, box.min[axis], -box.max[axis]}));
    return distance_sq > 0 ? std::sqrt(distance_sq) : 0.0f;
  }

  const SpaceOverPlane& space_;
  const DiskEdges& edges_;
  const Frame frame_;
  float clear_;
  int pieces_ = 0;
};

}  // namespace

float clear_distance(const Scene& scene, const SpaceOverPlane& space, const DiskEdges& edges,
                     float reach) {
  Search search(space, edges, reach);
  const auto take = [](void* context, const SurfacePiece& piece) {
    return static_cast<Search*>(context)->take(piece);
  };
  scene.tracer().pieces_near(space.origin, std::hypot(reach, space.highest), {take, &search});
  return search.clear();
}

}  // namespace kaustik
