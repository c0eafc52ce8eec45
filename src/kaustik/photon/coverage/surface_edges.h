#pragma once
#include <vector>

#include "kaustik/photon/coverage/clear_disk.h"
#include "kaustik/transport/vertex.h"

namespace kaustik {

/// Where the flat surface around a point ends, meets another or is overhung by one that stands
/// upright close above it, by rays in some directions: the straight lines that bound what can be
/// seen of its plane from the point, the nearest few.
class SurfaceEdges {
 public:
  SurfaceEdges() = default;
  /// Looks as far as `reach`, m. Counts its rays.
  SurfaceEdges(const Scene& scene, const SurfaceVertex& vertex, float reach, uint64_t& rays);

  /// Whether they hold at another vertex: it lies on the same side of the same
  /// plane, on the near side of all lines.
  bool hold_at(const SurfaceVertex& vertex) const;
  /// Those that cut the disk around such a vertex.
  DiskEdges around(const Vec3f& position, float radius) const;
  /// Whether nothing else was seen to end the surface within a disk.
  bool are_complete(const Vec3f& position, float radius) const {
    return length(position - position_) + radius <= complete_;
  }
  /// Whether nothing stands over such a disk, as far as the edges leave it. This does not rest on
  /// rays, which may miss what is small: no surface nearby is left out.
  bool are_clear(const Vec3f& position, float radius) const {
    return length(position - position_) + radius <= clear_;
  }
  /// The largest disk around such a position that is clear.
  ClearDisk clear_disk(const Vec3f& position) const;
  /// Whether a disk is clear, nothing was seen to end the surface within it, and no edge cuts it.
  bool is_whole(const Vec3f& position, float radius) const {
    return are_complete(position, radius) && are_clear(position, radius) &&
           around(position, radius).count == 0;
  }
  /// How far points of the plane may lie from one of them where they hold, m.
  float flatness() const;

 private:
  void find_lines(const Scene& scene, const SurfaceVertex& vertex, uint64_t& rays);

  struct Line {
    Vec3f inward;
    float distance;  ///< from position_
  };
  std::vector<Line> lines_;
  Vec3f position_{0, 0, 0},
      normal_{0, 0, 0};  ///< on the side that is seen; zero: looked at nothing
  float reach_ = 0;
  float complete_ = 0;  ///< how far nothing else was seen to end the surface, m
  float clear_ = 0;     ///< how far nothing else stands over the surface, m
};

}  // namespace kaustik
