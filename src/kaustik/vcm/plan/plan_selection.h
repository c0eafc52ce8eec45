#pragma once
#include <stop_token>
#include <string>

#include "kaustik/vcm/plan/plans.h"

namespace kaustik {

/// A cache has to be so much better than none, for its bias is not counted.
inline constexpr double worth_caching = 1.25;

/// Settles the plans, which have a pilot, with a cache if that pays.
void settle_with_cache(VcmPlans& plans);
/// The same plans with as many light paths as pay, if any do, and a cache if that pays, settled and
/// described. Worth nothing if it was stopped.
VcmPlans with_light_paths_that_pay(const VcmPlans& plans, const std::stop_token& stop);
/// How many lights camera paths sample, for the user. Empty: hardly any pixel has more than one.
std::string described_light_samples(const PixelPlans& pixels);

}  // namespace kaustik
