#pragma once
#include <stop_token>
#include <vector>

#include "kaustik/vcm/gathering/indirect_cache.h"
#include "kaustik/vcm/plan/pixel_plans.h"

namespace kaustik {

/// What caches that are filled for a trial tell of those of passes.
struct CacheTrial {
  std::vector<uint8_t> served;  ///< probe by probe: whether a cache has the light there …
  /// … with what variance, had records but one gather ray, …
  std::vector<float> ray_variance;
  /// … and with what by the light paths of the pilot alone, however many rays records have. Both as
  /// noise_in_common() counts them.
  std::vector<float> light_variance;
  double rays_per_ray = 0;  ///< to fill a cache, by gather rays of a record
};

/// Two caches by different gather rays, so that their difference is noise.
class TrialCaches {
 public:
  /// What `inputs` refer to, and `pixels`, must outlive this.
  TrialCaches(const GatherInputs& inputs, const PixelPlans& pixels, const std::stop_token& stop);

  /// Fills the next of their rounds. Worth nothing if it was stopped.
  CacheTrial next_round(const std::stop_token& stop);
  /// Traced so far.
  uint64_t rays() const { return caches_[0].rays() + caches_[1].rays(); }

 private:
  struct Difference;
  Difference difference_at(size_t probe) const;
  float in_common(const std::vector<Difference>& all) const;

  GatherInputs in_;
  const PixelPlans& pixels_;
  IndirectCache caches_[2];
};

/// Variance of all scattered light that the paths bring, relative to the square of its mean: what
/// all lookups have in common, at least.
double relative_variance(const LightVertices& light);

}  // namespace kaustik
