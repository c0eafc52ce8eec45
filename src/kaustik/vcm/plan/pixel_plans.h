#pragma once
#include <algorithm>
#include <cmath>
#include <memory>
#include <stop_token>
#include <vector>

#include "kaustik/base/bytes.h"
#include "kaustik/photon/coverage/seen_surfaces.h"
#include "kaustik/vcm/light_vertices.h"

namespace kaustik {

/// Where paths go on seldom they are worth less than they cost; more seldom than this, never.
inline constexpr float least_survival = 0.02f;

/// Bounds of the radius of a disk at the first vertex that is not learned, in widths of the pixel
/// there. A smaller one blurs less than the pixel does anyway, a larger one shows.
inline constexpr float least_disk_widths = 1, most_disk_widths = 6;

/// How much noise counts that pixels side by side share, relative to as much that every pixel has
/// for itself: by the sums of what filters of 1, 3 and 9 pixels on a side leave of its variance.
/// What they share is seen as a blotch. A filter of n pixels leaves (1 + s)/(n + s) of it, where
/// `spread`, s ≥ 0, is the number of pixels over which the noise of one is spread.
float noise_in_common(float spread);
/// Of noise that a whole picture shares, and more.
inline constexpr float spread_of_all = 1e9f;
/// The spread of what merges in disks of that radius, in widths of a pixel.
inline float spread_of_disk(float widths) {
  // ∫ of the square of the kernel, 1 − distance²/radius², over the square of its integral.
  constexpr float parabolic = 0.75f;
  return parabolic * pi * widths * widths;
}

/// What is decided for the first vertex of a pixel's camera paths whose event is not delta.
struct PixelPlan {
  float merge_area = 0;  ///< of the disk of merging, m²
  /// Chance of going on from there, but to look for lamps: by the diffuse lobe and by the glossy
  /// one, which camera paths sample better than merging does.
  float survival = 1, glossy_survival = 1;
  /// Mean square over variance of what a path that goes on finds: samples that hardly differ are
  /// worth more than their number (variance-aware weights, Grittmann et al. 2019).
  float evenness = 1;
  /// What share of the disk is surface and not hidden, about. 1 where radii are not learned.
  float covered = 1;
  /// The error of merging counts so many times, for pixels side by side share it:
  /// noise_in_common().
  float merging_in_common = 1;
  /// 1: kernels that edges cut have slopes, DiskKernel; 0: those would add more noise than they
  /// take off bias.
  int has_slopes = 1;
  /// Lights that are sampled there: where what they bring is most of the noise, several.
  int light_samples = 1;
  static constexpr int most_light_samples = 16;

  // What weights go by (PathHalves):
  /// All samples of a pixel merge with the same light vertices, which count but once.
  float counted_area(float camera_samples) const {
    return merge_area * covered / (camera_samples * merging_in_common);
  }
  float merge_radius() const { return std::sqrt(merge_area * inv_pi); }
  float counted_survival(float glossy_share) const {
    return mixed(survival * evenness, glossy_survival, glossy_share);
  }
  /// In a direction in which the glossy lobe has that share of f, BsdfValues::glossy_share().
  float survival_toward(float glossy_share) const {
    return mixed(survival, glossy_survival, glossy_share);
  }
  /// Where the surface is not that for which all of this was decided: it may be a narrow one.
  PixelPlan of_unknown_surface(float pixel_width) const;

 private:
  static float mixed(float diffuse, float glossy, float glossy_share) {
    return diffuse + (glossy - diffuse) * glossy_share;
  }
};

/// Camera samples per pixel, by blocks of pixels, of the passes of an epoch.
struct SampleSpread {
  /// No count is more than so many times the samples of a pass, nor 0.
  static constexpr uint32_t most_factor = 4;

  uint32_t begin = 0;                   ///< first pass of the epoch
  std::vector<uint32_t> counts;         ///< of a pass
  std::vector<uint32_t> first_indices;  ///< of a replicate's first pass of the epoch
  std::vector<uint32_t> next_indices;   ///< the same of the next epoch
};

/// The plans of the first pass: a table over blocks of pixels, and one radius for all vertices but
/// the first. The pixel's radius is that which some light vertices of a pilot pass take, within
/// least_disk_widths and most_disk_widths, unless RadiusLearning finds another. Whether paths go
/// on, and how many lights are sampled, is up to choose_plans().
class PixelPlans {
 public:
  PixelPlans() = default;
  /// For what the picture shows; no disks yet.
  explicit PixelPlans(const Scene& scene);
  /// So many vertices of a pass set a radius, as a pilot pass tells, which may have fewer paths.
  /// `given` > 0 is taken for all, m. `paths`: light paths of a pass.
  void choose_disks(const LightVertices& pilot, uint32_t paths, int neighbors, float given,
                    const std::stop_token& stop = {});

  /// SeenSurfaces::find_edges()
  void find_edges(const Scene& scene, float widths, float given, uint64_t& rays,
                  const std::stop_token& stop = {});

  /// All but what the picture shows, and the same back; throws as ByteReader does.
  void write(ByteWriter& writer) const;
  static PixelPlans read(ByteReader& reader, std::shared_ptr<const SeenSurfaces> seen);

  /// By a probe for each block of pixels.
  const SeenSurfaces& seen() const { return *seen_; }
  const std::shared_ptr<const SeenSurfaces>& shared_seen() const { return seen_; }
  /// Those of the probes.
  const std::vector<PixelPlan>& plans() const { return plans_; }
  /// The same with other plans, one for each probe.
  PixelPlans with(std::vector<PixelPlan> plans) const;

  /// Null: all pixels get as many camera samples.
  const std::shared_ptr<const SampleSpread>& spread() const { return spread_; }
  void set_spread(std::shared_ptr<const SampleSpread> spread) { spread_ = std::move(spread); }

  /// With disks of `shrinkage` times the area of those of the first pass.
  PixelPlan at(const Vec2f& raster, float shrinkage) const {
    PixelPlan plan = plans_[seen_->grid().index_at(raster)];
    plan.merge_area *= shrinkage;
    return plan;
  }
  /// The same for a first vertex that the pixel shows, there with that geometric normal on the side
  /// that is seen. It goes by the probe of those around that shows its surface; if none does, by
  /// PixelPlan::of_unknown_surface(), unless radii are given.
  PixelPlan at(const Vec2f& raster, float shrinkage, const Vec3f& position,
               const Vec3f& side) const;
  /// Area of the disk at all other vertices, m².
  float other_area() const { return other_area_; }

 private:
  /// Blocks whose probe found nothing get what is known of others nearby: a pixel may show more
  /// than its probe.
  void fill_gaps();

  std::shared_ptr<const SeenSurfaces> seen_ = std::make_shared<const SeenSurfaces>();
  std::shared_ptr<const SampleSpread> spread_;
  std::vector<PixelPlan> plans_{PixelPlan()};
  float other_area_ = 0;
  bool are_disks_given_ = false;  ///< one radius for all
};

}  // namespace kaustik
