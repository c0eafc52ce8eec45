#pragma once
#include <stop_token>
#include <vector>

#include "kaustik/vcm/camera_path/camera_path.h"
#include "kaustik/vcm/plan/efficiency.h"

namespace kaustik {

struct PilotLimits {
  double light_share = 1;  ///< light paths of the pilot for each of a real pass
  ComponentSet components = ComponentSet::all();  ///< that are wanted
};

/// A few camera paths at the probes of `plans`, or at some of them: 8 at most of each, and in all
/// no more than an eighth of a pass's camera samples (or 2¹³, if that is more), and than 2¹⁷; and
/// the light vertices that merge there: how well either way finds the light. `inputs`: of the pilot
/// pass; its weights know merging alone of what light paths do, and count those of a real pass.
/// What comes back is averaged over the probes around; one for each probe. Counts the rays. Returns
/// early once `stop` is requested.
std::vector<ProbeStatistics> probe_statistics(const CameraPathInputs& inputs,
                                              const PixelPlans& plans, const PilotLimits& limits,
                                              uint64_t& rays, const std::stop_token& stop = {});

}  // namespace kaustik
