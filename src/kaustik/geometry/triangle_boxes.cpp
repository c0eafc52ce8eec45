// Boxes around a mesh: the largest box is split again and again, at the median of its triangles (of
// some of them where there are many) or, when it holds a single one, by halving that triangle at
// its longest edge. So a pair of huge or long triangles gets tight boxes as well.

#include <algorithm>
#include <array>
#include <numeric>
#include <queue>

#include "kaustik/base/memory.h"
#include "kaustik/geometry/mesh_shape.h"
#include "kaustik/geometry/shape_support.h"

namespace kaustik {
namespace {

using TriangleCorners = std::array<Vec3d, 3>;

struct Piece {
  size_t begin = 0, end = 0;  ///< range of triangles; of one: `corners` is what is left of it
  TriangleCorners corners;
  Bounds3f box;
  float size = 0;
  bool operator<(const Piece& other) const { return size < other.size; }
};

class Splitter {
 public:
  explicit Splitter(const TriangleMesh& mesh) : mesh_(mesh) {
    reserve_large(order_, mesh.triangles.size());
    order_.resize(mesh.triangles.size());
    std::iota(order_.begin(), order_.end(), uint32_t(0));
  }

  std::vector<Bounds3f> boxes(size_t budget) {
    if (order_.empty()) return {};
    std::priority_queue<Piece> queue;
    queue.push(range(0, order_.size()));
    std::vector<Bounds3f> result;
    while (!queue.empty() && queue.size() + result.size() < budget) {
      const Piece piece = queue.top();
      queue.pop();
      if (!(piece.size > 0)) {
        result.push_back(piece.box);
        continue;
      }
      if (piece.end - piece.begin > 1)
        split_range(piece, queue);
      else
        halve_triangle(piece, queue);
    }
    for (; !queue.empty(); queue.pop()) result.push_back(queue.top().box);
    return result;
  }

 private:
  TriangleCorners corners(uint32_t triangle) const {
    const auto& c = mesh_.triangles[triangle];
    return {Vec3d(mesh_.positions[c[0]]), Vec3d(mesh_.positions[c[1]]),
            Vec3d(mesh_.positions[c[2]])};
  }

  static Piece finish(Piece piece, const Imath::Box3d& box) {
    piece.box = rounded_outward(box.min, box.max);
    const Vec3d d = box.max - box.min;
    // A flat box still has a size: its longest side, little beside an area of the same extent.
    const double longest = std::max({d.x, d.y, d.z});
    piece.size = float(d.x * d.y + d.y * d.z + d.z * d.x + 1e-3 * longest * longest);
    return piece;
  }

  Piece range(size_t begin, size_t end) const {
    Imath::Box3d box;
    for (size_t i = begin; i < end; ++i)
      for (const Vec3d& p : corners(order_[i])) box.extendBy(p);
    return finish({begin, end, corners(order_[begin]), {}, 0}, box);
  }

  static Piece part_of(const Piece& whole, const TriangleCorners& corners) {
    Imath::Box3d box;
    for (const Vec3d& p : corners) box.extendBy(p);
    return finish({whole.begin, whole.end, corners, {}, 0}, box);
  }

  double centroid(uint32_t triangle, int axis) const {
    const TriangleCorners c = corners(triangle);
    return c[0][axis] + c[1][axis] + c[2][axis];
  }

  void split_range(const Piece& piece, std::priority_queue<Piece>& queue) {
    const Vec3f d = piece.box.max - piece.box.min;
    const int axis = d.x >= d.y && d.x >= d.z ? 0 : d.y >= d.z ? 1 : 2;
    const size_t middle = middle_of(piece, axis);
    queue.push(range(piece.begin, middle));
    queue.push(range(middle, piece.end));
  }

  /// Where the upper half along the axis begins, after the triangles are put in order; both halves
  /// have some.
  size_t middle_of(const Piece& piece, int axis) {
    constexpr size_t many = 1 << 14, sample_count = 1023;
    const size_t count = piece.end - piece.begin;
    const auto at = [&](size_t i) { return order_.begin() + std::ptrdiff_t(i); };
    if (count > many) {
      // Each triangle lies somewhere else in memory: they are looked at once.
      std::array<double, sample_count> sample;
      for (size_t i = 0; i < sample_count; ++i)
        sample[i] = centroid(order_[piece.begin + i * count / sample_count], axis);
      std::nth_element(sample.begin(), sample.begin() + sample_count / 2, sample.end());
      const double median = sample[sample_count / 2];
      const auto upper = std::stable_partition(
          at(piece.begin), at(piece.end),
          [&](uint32_t triangle) { return centroid(triangle, axis) < median; });
      const auto lower_count = size_t(upper - at(piece.begin));
      if (lower_count > count / 4 && lower_count < count - count / 4)
        return piece.begin + lower_count;
    }
    const size_t middle = (piece.begin + piece.end) / 2;
    std::nth_element(at(piece.begin), at(middle), at(piece.end), [&](uint32_t a, uint32_t b) {
      const double ca = centroid(a, axis), cb = centroid(b, axis);
      return ca < cb || (ca == cb && a < b);
    });
    return middle;
  }

  static void halve_triangle(const Piece& piece, std::priority_queue<Piece>& queue) {
    const TriangleCorners& c = piece.corners;
    size_t longest = 0;
    double length_sq_longest = -1;
    for (size_t i = 0; i < 3; ++i)
      if (const double l = (c[(i + 1) % 3] - c[i]).length2(); l > length_sq_longest) {
        length_sq_longest = l;
        longest = i;
      }
    const Vec3d &a = c[longest], &b = c[(longest + 1) % 3], &tip = c[(longest + 2) % 3];
    const Vec3d middle = (a + b) * 0.5;
    queue.push(part_of(piece, {a, middle, tip}));
    queue.push(part_of(piece, {middle, b, tip}));
  }

  const TriangleMesh& mesh_;
  std::vector<uint32_t> order_;
};

}  // namespace

std::vector<Bounds3f> triangle_boxes(const TriangleMesh& mesh, int budget) {
  return Splitter(mesh).boxes(size_t(std::max(1, budget)));
}

}  // namespace kaustik
