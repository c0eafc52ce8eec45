#pragma once
#include <cstdint>
#include <vector>

#include "kaustik/irradiance/cache_record.h"

namespace kaustik {

/// Finds the records that serve a point. A leaf of the octree lists every record whose reach
/// overlaps it, with a copy of what the test needs in SIMD blocks: a query walks down to one leaf
/// and reads its blocks one after the other.
///
/// The error of a record for a point at the offset d is
///   ε² = d²/reach² + (d·squeeze)² + (c h/r)² + t (1 − n·n')/a²,
/// with the shorter reach r, the record's factor of turning t, the height h over the plane between
/// both normals, and c larger behind the record than in front of it: a smooth form of Ward's d/R +
/// √(1 − n·n') (1988) and of his test for points in front of the record. Who sees the point with
/// pixels less than half as wide as those that the record was made for asks for more: all lengths
/// then count by so many times more. The record serves the point where ε < 1 and takes part in
/// interpolation, with a weight that falls to zero, where ε < overlap.
class RecordOctree {
 public:
  /// Records take part in interpolation this much beyond where they serve, so that neighbours
  /// blend and their noise is averaged.
  static constexpr float overlap = 1.8f;

  RecordOctree() = default;
  /// `normal_tolerance`: the a of the formula. All numbers in the records must be finite.
  RecordOctree(std::vector<CacheRecord> records, float normal_tolerance);

  /// Whether any record serves the point with an error ε below `tolerance` ≤ overlap.
  /// `pixel_width`: of who asks, m; 0: unknown, and then the record's doesn't matter.
  bool serves(const Vec3f& position, const Vec3f& normal, float tolerance = 1,
              float pixel_width = 0) const;
  /// Weighted mean of the records' extrapolations, in which negative lanes become zero (further
  /// than its gradients hold a record knows no better). False where there are none. All reaches
  /// are multiplied by `relax` ≥ 1; of records that serve only so those take part that the point's
  /// leaf lists anyway: to search the whole tree for the others costs more than it finds.
  bool interpolate(const Vec3f& position, const Vec3f& normal, float relax, Spectrum& irradiance,
                   float pixel_width = 0) const;
  size_t size_in_bytes() const;
  const std::vector<CacheRecord>& records() const { return records_; }

 private:
  using Lanes = float __attribute__((vector_size(16)));
  using Mask = int32_t __attribute__((vector_size(16)));

  struct Block {
    Lanes position[3];
    Lanes normal[3];  ///< zero in unused lanes, which therefore never serve
    Lanes squeeze[3];
    Lanes inverse_reach_sq, inverse_minor_sq;
    Lanes turning;
    Lanes half_pixel_sq;  ///< square of half the record's pixel width
    uint32_t record[4];
  };
  struct Node {
    uint32_t first = 0;   ///< first of eight children, or first block
    uint32_t blocks = 0;  ///< of a leaf
    bool inner = false;
  };
  struct Point {
    Point(const Vec3f& p, const Vec3f& n, float pixel_width)
        : position(p), normal(n), inverse_pixel_sq(pixel_width > 0 ? 1 / sqr(pixel_width) : 0) {}
    Vec3f position, normal;
    float inverse_pixel_sq;
  };
  struct Mean {
    Spectrum weighted;
    float weight = 0;
    void add(const CacheRecord& record, const Point& at, float w) {
      w *= record.confidence;
      weighted += record.extrapolate(at.position - record.position, at.normal) * w;
      weight += w;
    }
  };
  class Builder;

  Lanes error_sq(const Block& block, const Point& at) const;
  static Lanes weight(Lanes error_sq, float limit_sq);
  const Node* leaf_at(const Vec3f& position) const;
  void accumulate(const Node& leaf, const Point& at, float relax, Mean& mean) const;

  std::vector<CacheRecord> records_;
  std::vector<Node> nodes_;
  std::vector<Block> blocks_;
  Vec3f lower_{0, 0, 0};
  float size_ = 0;             ///< edge of the root cube, m
  float cells_per_metre_ = 0;  ///< of the finest level
  float inverse_normal_tolerance_sq_ = 0;
};

}  // namespace kaustik
