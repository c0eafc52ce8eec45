#pragma once
#include <array>
#include <vector>

#include "kaustik/vcm/plan/pixel_plans.h"
#include "kaustik/vcm/plan/plan_choices.h"

namespace kaustik {

/// What pilot paths tell, at one probe, of the light that the probed vertex sends to the camera.
/// f is such light by paths of at least one more event, p the density with which a camera path that
/// goes on from the vertex finds it, m the number of vertices of a pass's light paths that merge
/// there for it.
struct ProbeStatistics {
  static constexpr int bin_count = 32;
  static constexpr int bin_of_one = 12;  ///< where m/p is 1; each bin is twice the one before
  /// ∫ f²/p in bins of m/p: all that variances of mixtures of both depend on. Of the light that the
  /// diffuse lobe scatters …
  std::array<double, bin_count> squares{};
  double merged_alone = 0;  ///< ∫ f²/m where no camera path goes
  /// … and of that of the glossy one: what both do is split by their shares of f.
  std::array<double, bin_count> glossy_squares{};
  double glossy_merged_alone = 0;
  double path_mean_square = 0, path_variance = 0;  ///< of what a camera path finds, but for what
                                                   ///< merging finds far more often
  /// Of direct light by camera samples that sample one light at the vertex, with the lamp that the
  /// path meets next: the variance of the mean of some samples of a pixel, 4 at most, times their
  /// number. They stratify one another, …
  double direct_variance = 0;
  double single_direct_variance = 0;  ///< … that of one alone is larger …
  /// …, and this is the part of the latter that falls as 1/n where n lights are sampled there.
  double light_sample_variance = 0;
  double radiance = 0;  ///< of everything
  double merged = 0;    ///< light vertices of a pass within the disk
  double rays = 0;      ///< per camera sample up to the lamp that the path may meet next …
  /// … and of a path that goes on there, by the same split.
  double rays_beyond = 0, glossy_rays_beyond = 0;
  double light_sample_rays = 0;  ///< of a sample of a light at the vertex; one is in `rays`

  /// `squares` … `path_variance` and `merged` without diffuse indirect light, where a cache may
  /// have it.
  struct Ungathered {
    std::array<double, bin_count> squares{}, glossy_squares{};
    double merged_alone = 0, glossy_merged_alone = 0, path_mean_square = 0, path_variance = 0,
           merged = 0;
  } ungathered;
  double gathered = 0;  ///< that light, by camera paths and by what merges, in no known proportion
  /// Whether any of that light was found.
  bool has_diffuse_indirect() const { return gathered > 0; }
  double cache_share = 0;     ///< 1 where a cache has that light, …
  double cache_variance = 0;  ///< … which then has this variance in a pass by its gather rays, …
  double cache_light_variance = 0;  ///< … and this by the light paths that they look up. Both as
                                    ///< noise_in_common() counts them.
  /// What is left where a cache has that light with these variances.
  ProbeStatistics with_cache(double variance, double light_variance) const;

  void add(const ProbeStatistics& other, double weight);
};

/// How merging at a probe differs from what the statistics were taken with.
struct MergeScale {
  double area = 1;         ///< of the disk, relative
  double light_paths = 1;  ///< of a pass, relative
  double in_common = 1;    ///< PixelPlan::merging_in_common
};

/// What all probes of a picture have in common.
struct PassCosts {
  double camera_samples = 1;  ///< per pixel and pass
  double light_rays = 0;      ///< of a pass per camera sample, with MergeScale::light_paths 1
  double cache_rays = 0;      ///< to fill the cache, of a pass per camera sample
  double pixels = 1;
};

/// What a pass is expected to cost, in rays per camera sample, and to leave as mean squared error
/// relative to the picture.
struct Efficiency {
  double squared_error = 0;
  /// The same, where the errors of the hundredth of the probes with the largest count as the
  /// largest of the others. A few probes may have half of all error, most often of direct light
  /// that few samples tell badly. What is done about the light of the others is judged without.
  double typical_squared_error = 0;
  double rays = 0;
  /// Of what a given error takes.
  double time() const { return squared_error * rays; }
  double typical_time() const { return typical_squared_error * rays; }
};

/// What a camera sample takes beside the rays of its path, in rays, on average: merging, and its
/// part of the light paths. `scales` by probe.
double rays_beside_camera_paths(const std::vector<ProbeStatistics>& probes, const PassCosts& costs,
                                const std::vector<MergeScale>& scales);

/// Chooses for every probe how often camera paths go on from its vertex, and how many lights are
/// sampled there, so that the product of the picture's variance and its cost is least (Grittmann et
/// al. 2022 choose techniques that way).
/// With κ = S s v and ν the light paths relative to the pilot's the variance of a pass is that of
/// the balance heuristic, ∫ f² / (κ p + ν m): S camera samples, of which a share s goes on, and v
/// the ratio of their mean square to their variance (variance-aware weights, Grittmann et al.
/// 2019). To this comes the variance of direct light over S, a part of which n samples of lights
/// divide by n, and that of what a cache has.
/// Writes survival, glossy_survival, evenness and light_samples of `plans`, one for each probe, and
/// returns what is expected. `scales` by probe; light_paths 0: nothing merges. What is not asked
/// for is written as 1.
Efficiency choose_plans(const std::vector<ProbeStatistics>& probes, const PassCosts& costs,
                        const std::vector<MergeScale>& scales, const PlanChoices& choices,
                        std::vector<PixelPlan>& plans);

}  // namespace kaustik
