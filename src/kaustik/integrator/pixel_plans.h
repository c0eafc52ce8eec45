#pragma once
#include <algorithm>
#include <memory>
#include <stop_token>
#include <vector>

#include "kaustik/integrator/pixel_probes.h"
#include "kaustik/integrator/surface_edges.h"
#include "kaustik/photon/light_vertices.h"

namespace kaustik {

/// Where paths go on seldom they are worth less than they cost; more seldom than this, never.
inline constexpr float least_survival = 0.02f;

/// What is decided for the first vertex of a pixel's camera paths whose event is not delta.
struct PixelPlan {
  float merge_area = 0;  ///< of the disk of merging, m²
  float survival = 1;    ///< chance of going on from there, but to look for lamps
  /// Mean square over variance of what a path that goes on finds: samples that hardly differ are
  /// worth more than their number (variance-aware weights, Grittmann et al. 2019).
  float evenness = 1;
  float connected = 1;  ///< whether camera vertices are connected to those of light paths: 0 or 1

  // What weights go by (PathHalves):
  /// All samples of a pixel merge with the same light vertices, which count but once.
  float counted_area(float camera_samples) const { return merge_area / camera_samples; }
  float counted_survival() const { return survival * evenness; }
};

/// Camera samples per pixel, by blocks of pixels, of the passes of an epoch.
struct SampleSpread {
  uint32_t begin = 0;                   ///< first pass of the epoch
  std::vector<uint32_t> counts;         ///< of a pass
  std::vector<uint32_t> first_indices;  ///< of a replicate's first pass of the epoch
  std::vector<uint32_t> next_indices;   ///< the same of the next epoch
};

/// The plans of the first pass: a table over blocks of pixels, and one radius for all vertices but
/// the first. The pixel's radius is that which some light vertices of a pilot pass take, within
/// bounds from the pixel's footprint: smaller ones would blur less than the pixel does anyway,
/// larger ones show. Whether paths go on is up to choose_survival().
class PixelPlans {
 public:
  static constexpr int block_size = 4;  ///< pixels on a side
  PixelPlans() = default;
  /// With probes, but no disks yet.
  explicit PixelPlans(const Scene& scene);
  /// So many vertices of a pass set a radius, as a pilot pass tells, which may have fewer paths.
  /// `given` > 0 is taken for all, m. `paths`: light paths of a pass.
  void choose_disks(const LightVertices& pilot, uint32_t paths, int neighbors, float given,
                    const std::stop_token& stop = {});

  /// Looks for the edges of what the probes show, for disks of so many widths of a pixel, or of
  /// `given` > 0, m, around all that their blocks show. Counts its rays.
  void find_edges(const Scene& scene, float widths, float given, uint64_t& rays,
                  const std::stop_token& stop = {});

  /// What was found that holds at a vertex that a pixel shows, by the probes around; null: nothing.
  const SurfaceEdges* edges_at(const Vec2f& raster, const SurfaceVertex& vertex) const;

  struct Surroundings {
    DiskEdges edges;
    bool are_complete = false;  ///< nothing else was seen to end the surface
    /// Nothing hides points of the disk from one another that lie no farther from its plane than
    /// this, m. 0: that is not known.
    float clear_flatness = 0;
    bool are_clear() const { return clear_flatness > 0; }
  };
  /// Of a disk around a vertex that a pixel shows, by the probes around.
  Surroundings surroundings(const Vec2f& raster, const SurfaceVertex& vertex, float radius) const;
  /// The same around a probe.
  Surroundings surroundings(size_t probe, float radius) const;
  /// One per block of pixels, row by row.
  const std::vector<PixelProbe>& probes() const { return *probes_; }
  const Vec2i& blocks() const { return blocks_; }
  /// What the blocks cover: the picture, or the crop window with what is around it.
  const PlanWindow& window() const { return window_; }
  /// Those of the probes.
  const std::vector<PixelPlan>& plans() const { return plans_; }
  /// The same with other plans, one for each probe.
  PixelPlans with(std::vector<PixelPlan> plans) const;

  /// Null: all pixels get as many camera samples.
  const std::shared_ptr<const SampleSpread>& spread() const { return spread_; }
  void set_spread(std::shared_ptr<const SampleSpread> spread) { spread_ = std::move(spread); }
  size_t block_of(const Vec2i& pixel) const {
    return index_of(block_at(Vec2f(float(pixel.x), float(pixel.y))));
  }

  /// With disks of `shrinkage` times the area of those of the first pass.
  PixelPlan at(const Vec2f& raster, float shrinkage) const {
    PixelPlan plan = plans_[index_of(block_at(raster))];
    plan.merge_area *= shrinkage;
    return plan;
  }
  /// Area of the disk at all other vertices, m².
  float other_area() const { return other_area_; }
  /// Mean distance of what the camera sees first in the whole picture, m.
  float mean_distance() const { return mean_distance_; }

 private:
  /// Blocks whose probe found nothing get what is known of others nearby: a pixel may show more
  /// than its probe.
  void fill_gaps();

  Vec2i block_at(const Vec2f& raster) const {
    const Vec2f at = raster + Vec2f(float(window_.before.x), float(window_.before.y));
    return {std::clamp(int(at.x) / block_size, 0, blocks_.x - 1),
            std::clamp(int(at.y) / block_size, 0, blocks_.y - 1)};
  }
  size_t index_of(const Vec2i& block) const {
    return size_t(block.y) * size_t(blocks_.x) + size_t(block.x);
  }

  std::shared_ptr<const std::vector<PixelProbe>> probes_;
  std::shared_ptr<const std::vector<SurfaceEdges>> edges_;  ///< of each probe; null: not looked for
  std::shared_ptr<const SampleSpread> spread_;
  PlanWindow window_;
  Vec2i blocks_{1, 1};
  std::vector<PixelPlan> plans_{PixelPlan()};
  float other_area_ = 0;
  float mean_distance_ = 0;
};

}  // namespace kaustik
