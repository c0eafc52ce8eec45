#pragma once
#include <array>
#include <cmath>
#include <stop_token>
#include <vector>

#include "kaustik/vcm/plan/pixel_plans.h"

namespace kaustik {

/// How far merging may reach without showing, learned from the light paths of finished passes: at
/// one probe per block of pixels the light within disks of growing radius is summed up, and the
/// widest disk is taken whose light agrees with that of every smaller one, up to their noise
/// (Lepski's choice of bandwidth, 1991). The noise falls with the number of passes, so the radii
/// follow.
class RadiusLearning {
 public:
  static constexpr int level_count = 10;  ///< radii from one pixel on, each √2 times the one before
  /// The widest, in widths of a pixel.
  static float widest_widths() { return std::exp2(0.5f * float(level_count - 1)); }
  /// Light that came by specular events only, and the rest: caustics have edges, which the noise of
  /// what little else there is must not hide.
  static constexpr size_t kind_count = 2;
  /// Sums over light vertices within each disk of a probe, over passes, by kind: of the light that
  /// they would send, its squares, and it times where they lie, in the frame of the probe, m.
  struct KindSums {
    std::array<double, level_count> light{}, squares{}, x{}, y{};
    void add(const KindSums& other) {
      for (size_t i = 0; i < size_t(level_count); ++i) {
        light[i] += other.light[i];
        squares[i] += other.squares[i];
        x[i] += other.x[i];
        y[i] += other.y[i];
      }
    }
  };
  struct Sums {
    std::array<KindSums, kind_count> of;
    std::array<double, level_count> vertices{};  ///< wanted or not
    /// Disks from this one on are no longer summed up: see narrow().
    size_t levels = level_count;
    void add(const Sums& other) {
      for (size_t i = 0; i < size_t(level_count); ++i) vertices[i] += other.vertices[i];
      for (size_t k = 0; k < kind_count; ++k) of[k].add(other.of[k]);
    }
  };

  /// How much the disks of a probe disagree: for each pair of levels the squared difference of
  /// their lights over its variance, about 1 where there is nothing but noise. By kind; of a kind
  /// that counts for little, none.
  struct Disagreement {
    using Pairs = std::array<std::array<float, level_count>, level_count>;
    std::array<Pairs, kind_count> of{};  ///< [kind][level][smaller level]
  };

  /// Learns at the probes of `first`, the plans of the first pass: looks how much of their disks is
  /// covered, and counts the rays. Worth nothing if it was stopped.
  RadiusLearning(const Scene& scene, const PixelPlans& first, uint64_t& rays,
                 const std::stop_token& stop = {});

  /// What the light vertices of one pass add to `so_far`, per probe of `first`. Worth nothing if it
  /// was stopped.
  static std::vector<Sums> sums_of(const PixelPlans& first, const LightVertices& light,
                                   ComponentSet wanted, const std::vector<Sums>& so_far,
                                   const std::stop_token& stop = {});
  /// Leaves out disks in which `passes` passes had so many light vertices that none will be taken:
  /// most vertices of a dense caustic are in them.
  static void narrow(std::vector<Sums>& sums, uint32_t passes);
  /// The plans for what `passes` passes, or a part of one, have summed up: those of the first pass
  /// with other disks, whose kernels have slopes where that takes off more bias than it adds noise.
  /// Shrinking is up to the caller, `shrinkage` of the areas is taken off beforehand. No disk is
  /// wider than so many widths of a pixel.
  std::vector<PixelPlan> plans(const PixelPlans& first, const std::vector<Sums>& sums,
                               double passes, float shrinkage, float most_widths = infinity) const;

 private:
  int widest_level(const std::vector<Disagreement>& disagreements, const std::vector<Sums>& sums,
                   const PixelPlans& first, size_t probe) const;

  /// A disk of a probe: what its edges leave of it, and how that is covered.
  struct Level {
    DiskMoments moments;  ///< of what edges leave, over the radius
    double radius = 0;    ///< m
    double share = 0;     ///< of what edges leave that is covered
    // The factor of light at (x, y), 1/m²: scale (1 + x slope_x + y slope_y).
    double scale = 0, slope_x = 0, slope_y = 0;  ///< 1/m², 1/m, 1/m
  };
  using Levels = std::array<Level, level_count>;
  /// What share of a disk of that radius is surface and not hidden.
  static float covered(const Levels& levels, float widths);
  /// Squared difference of the lights of a disk with slopes and without over its variance; less
  /// than 0: there are no slopes, or nothing to tell it by.
  static float worth_of_slopes(const Sums& sums, const Level& level, size_t number);
  bool are_slopes_worth(const std::vector<Sums>& sums, const PixelPlans& first, size_t probe,
                        int level) const;
  static Levels levels_of(const Scene& scene, const PixelProbe& probe, const PixelPlans& first,
                          size_t number, uint64_t& rays);
  static Disagreement::Pairs disagreement_of(const KindSums& sums, size_t count,
                                             const Levels& levels);
  static Disagreement disagreement_of(const Sums& sums, const Levels& levels);

  std::vector<Levels> levels_;  ///< of each probe
};

}  // namespace kaustik
