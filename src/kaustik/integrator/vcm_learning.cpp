#include "kaustik/integrator/vcm_learning.h"

#include <algorithm>
#include <bit>

#include "kaustik/photon/photon_map.h"

namespace kaustik {
namespace {

/// Passes that are learned from at most.
constexpr uint32_t most_learned_passes = 256;
/// The same for emission; of each epoch the last pass.
constexpr uint32_t most_guided_passes = 16;

bool teaches_emission(uint32_t pass) {
  return pass < most_guided_passes && std::has_single_bit(pass + 1);
}

bool learns_radii(const VcmPlans& plans, const VcmSettings& settings) {
  return plans.techniques.merging && settings.learn_radii && !(settings.radius > 0);
}

}  // namespace

VcmLearning::VcmLearning(std::shared_ptr<const VcmPlans> first, const VcmSettings& settings)
    : first_(std::move(first)),
      settings_(settings),
      learns_radii_(learns_radii(*first_, settings)) {}

uint32_t VcmLearning::learned_passes(const VcmPlans& first, const VcmSettings& settings) {
  if (!first.techniques.needs_light_paths()) return 0;
  if (learns_radii(first, settings)) return most_learned_passes;
  return first.use ? most_guided_passes : 0;
}

uint32_t VcmLearning::epoch_begin(uint32_t pass, uint32_t learned_passes) {
  return std::min(learned_passes, std::bit_floor(pass));
}

uint32_t VcmLearning::remembered_paths(uint32_t pass, const VcmPlans& plans) {
  return plans.use && teaches_emission(pass) ? LightPathUse::most_paths : 0;
}

bool VcmLearning::wants_next() const {
  return learns_radii_ || (use_ && teaches_emission(passes_));
}

bool VcmLearning::expects(const Pass& pass) const {
  const uint32_t learned = learned_passes(*first_, settings_);
  // Sums of an epoch whose plans are still to be made stay as they are.
  return seed_ == pass.seed && passes_ == pass.index &&
         first_->samples_per_pixel == pass.samples_per_pixel && pass.index < learned &&
         epochs_.contains(epoch_begin(pass.index, learned));
}

void VcmLearning::begin(uint64_t seed) {
  seed_ = seed;
  sums_.assign(learns_radii_ ? first_->pixels.probes().size() : 0, {});
  use_ = first_->use ? std::make_unique<LightPathUse>(*first_->use) : nullptr;
  passes_ = 0;
  epochs_ = {{0, first_}};
}

void VcmLearning::learn(const LightVertices& light) {
  if (learns_radii_) {
    const auto added = RadiusLearning::sums_of(first_->pixels, light, settings_.components);
    for (size_t i = 0; i < added.size(); ++i) sums_[i].add(added[i]);
  }
  if (use_ && teaches_emission(passes_)) use_->learn(light);
  ++passes_;
}

std::shared_ptr<const VcmPlans> VcmLearning::plans_of(uint32_t epoch, const Scene& scene,
                                                      const std::stop_token& stop, uint64_t& rays) {
  const auto found = epochs_.find(epoch);
  if (found != epochs_.end()) return found->second;
  if (learns_radii_ && !radii_) {
    RadiusLearning made(scene, first_->pixels, rays, stop);
    if (stop.stop_requested()) return first_;
    radii_ = std::move(made);
  }
  auto plans = std::make_shared<VcmPlans>(*epochs_.rbegin()->second);
  if (learns_radii_) {
    const float shrinkage = sqr(pass_radius(1, passes_));
    plans->settle(radii_->plans(first_->pixels, sums_, passes_, shrinkage), shrinkage);
  }
  if (use_)
    if (const auto learned = use_->emission().learned()) plans->emission = learned;
  if (passes_ >= most_guided_passes) use_.reset();
  return epochs_[epoch] = std::move(plans);
}

}  // namespace kaustik
