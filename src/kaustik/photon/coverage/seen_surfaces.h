#pragma once
#include <memory>
#include <stop_token>
#include <vector>

#include "kaustik/photon/coverage/pixel_probes.h"
#include "kaustik/photon/coverage/surface_edges.h"

namespace kaustik {

/// What ends the surface, or hides parts of it from one another, within a disk.
struct DiskBounds {
  DiskEdges edges;
  bool are_complete = false;  ///< nothing else was seen to end the surface
  /// Nothing hides points of the disk from one another that lie no farther from its plane than
  /// this, m. 0: that is not known.
  float clear_flatness = 0;
  bool are_clear() const { return clear_flatness > 0; }
};

/// The surfaces that a picture shows, by a probe for each block of pixels, and the edges that end
/// them around the probes.
class SeenSurfaces {
 public:
  /// Pixels on a side of a block: as many as leave about a hundred blocks on a side of the picture,
  /// within these bounds, for looking at them is not to take long beside a pass; 1 where pixels are
  /// apart. Of a crop window the same as of the whole picture.
  static int block_size_of(const Scene& scene);
  static constexpr int least_block_size = 4, most_block_size = 8;
  SeenSurfaces() = default;
  /// With probes, but no edges yet.
  explicit SeenSurfaces(const Scene& scene);

  /// Looks for the edges of what the probes show, for disks of so many widths of a pixel, or of
  /// `given` > 0, m, around all that their blocks show. Counts its rays.
  void find_edges(const Scene& scene, float widths, float given, uint64_t& rays,
                  const std::stop_token& stop = {});

  /// What was found that holds at a vertex that a pixel shows, by the probes around; null: nothing.
  const SurfaceEdges* edges_at(const Vec2f& raster, const SurfaceVertex& vertex) const;
  /// Of a disk around a vertex that a pixel shows, by the probes around.
  DiskBounds disk_bounds(const Vec2f& raster, const SurfaceVertex& vertex, float radius) const;
  /// The same around a probe.
  DiskBounds disk_bounds(size_t probe, float radius) const;

  /// One per block.
  const std::vector<PixelProbe>& probes() const { return probes_; }
  const BlockGrid& grid() const { return grid_; }
  /// Mean distance of what the camera sees first in the whole picture, m.
  float mean_distance() const { return mean_distance_; }

 private:
  BlockGrid grid_;
  std::vector<PixelProbe> probes_;
  std::vector<SurfaceEdges> edges_;  ///< of each probe; empty: not looked for
  float mean_distance_ = 0;
};

}  // namespace kaustik
