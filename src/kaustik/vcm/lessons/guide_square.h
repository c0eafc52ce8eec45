#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "kaustik/base/bytes.h"

#include "kaustik/base/vec.h"

namespace kaustik {

/// A density on the unit square that is learned from points with weights: a quadtree whose leaves
/// are drawn in proportion to √(weight × area), which is what makes the variance of a sum least
/// when the weights are squares (Müller et al. 2017 for the tree; Rath et al. 2020 for the root).
/// Leaves with few points lean on those around them. Immutable.
class GuideSquare {
 public:
  struct Point {
    Vec2f u;            ///< in [0, 1)²
    double weight = 0;  ///< a square of what the point brings, over the density it was found with
  };
  /// Some of the weights must be above zero.
  explicit GuideSquare(std::vector<Point> points);

  /// Keeps the stratification of `u`, which is uniform.
  Vec2f sample(Vec2f u) const;
  /// Per area of the square; zero outside of it.
  float pdf(const Vec2f& u) const;
  /// The sum of weight / pdf that the learned density is expected to leave, (Σ √(weight × area))².
  double expected_sum() const { return expected_sum_; }
  void write(ByteWriter& writer) const;
  /// Throws as ByteReader does.
  static GuideSquare read(ByteReader& reader);
  size_t leaves() const { return (3 * nodes_.size() + 1) / 4; }

 private:
  GuideSquare() = default;
  struct Node {
    uint32_t children = 0;    ///< the first of four; 0: a leaf
    float left = 0;           ///< share of the two on the left …
    float lower[2] = {0, 0};  ///< … and of the lower one of two, on the left and on the right
    float density = 0;        ///< of a leaf
  };
  using Points = std::vector<Point>::iterator;
  struct Range {
    Points begin, end;
    Vec2f corner;
    float size;
  };
  double build(uint32_t node, const Range& range, double weight, int depth, size_t most);
  void set_densities(uint32_t node, double density);

  std::vector<Node> nodes_;
  double expected_sum_ = 0;
};

}  // namespace kaustik
