#include "kaustik/vcm/lessons/learning.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "kaustik/photon/photon_map.h"

namespace kaustik {
namespace {

/// Passes that are learned from at most.
constexpr uint32_t most_learned_passes = 256;
/// The same for what guides light paths; of each epoch the last pass.
constexpr uint32_t most_guided_passes = 16;

bool teaches_emission(uint32_t pass) {
  return pass < most_guided_passes && std::has_single_bit(pass + 1);
}

bool learns_radii(const VcmPlans& plans, const VcmSettings& settings) {
  return plans.techniques.merging && settings.learn_radii && !(settings.radius > 0);
}

bool learns_samples(const VcmPlans& plans, const VcmSettings& settings) {
  // A single sample can't be shared out.
  return settings.adaptive && plans.pilot && plans.samples_per_pixel > 1;
}

bool learns_connections(const VcmPlans& plans, const VcmSettings& settings) {
  return settings.chooses_connections && plans.pilot && plans.techniques.merging;
}

/// Those of the epoch that begins with pass `begin`, after `before` (null: `samples` everywhere).
/// No index comes twice in a replicate, and as few as can be are left out.
std::shared_ptr<const SampleSpread> spread_of(uint32_t begin, std::vector<uint32_t> counts,
                                              const SampleSpread* before, uint32_t samples) {
  SampleSpread result{begin, std::move(counts), {}, {}};
  // A replicate has one pass at most in all the epochs before the 16th pass.
  const bool is_first_round = begin < replicate_count;
  const uint32_t rounds_before = std::max(1u, begin / replicate_count);
  for (size_t i = 0; i < result.counts.size(); ++i) {
    const uint32_t count = result.counts[i];
    // From a multiple on: whole runs of a sequence stratify one another best.
    const uint32_t before_it = before ? before->next_indices[i] : rounds_before * samples;
    const uint32_t used = (before_it + count - 1) / count * count;
    result.first_indices.push_back(is_first_round ? 0 : used);
    // Epochs are as long as all passes before them.
    result.next_indices.push_back(is_first_round ? std::max(used, count)
                                                 : used + rounds_before * count);
  }
  return std::make_shared<const SampleSpread>(std::move(result));
}

}  // namespace

VcmLearning::VcmLearning(std::shared_ptr<const VcmPlans> first, const VcmSettings& settings)
    : first_(std::move(first)),
      settings_(settings),
      learns_radii_(learns_radii(*first_, settings)),
      no_samples_(learns_samples(*first_, settings)
                      ? SampleLearning(first_->pixels.seen().grid(),
                                       !first_->techniques.needs_light_paths())
                      : SampleLearning()),
      no_connections_(learns_connections(*first_, settings)
                          ? ConnectionLearning(first_->pixels.seen().grid())
                          : ConnectionLearning()) {}

uint32_t VcmLearning::learned_passes(const VcmPlans& first, const VcmSettings& settings) {
  uint32_t passes = learns_samples(first, settings) ? SampleLearning::most_passes : 0;
  if (learns_connections(first, settings))
    passes = std::max(passes, ConnectionLearning::first_pass + ConnectionLearning::pass_count);
  if (!first.techniques.needs_light_paths()) return passes;
  if (learns_radii(first, settings)) return most_learned_passes;
  return std::max(passes, first.use ? most_guided_passes : 0);
}

bool VcmLearning::wants_samples(uint32_t pass, const VcmPlans& first, const VcmSettings& settings) {
  return learns_samples(first, settings) && pass < SampleLearning::most_passes;
}

bool VcmLearning::tries_connections(uint32_t pass, const VcmPlans& first,
                                    const VcmSettings& settings) {
  return learns_connections(first, settings) && ConnectionLearning::tries_in(pass);
}

uint32_t VcmLearning::epoch_begin(uint32_t pass, uint32_t learned_passes) {
  return std::min(learned_passes, std::bit_floor(pass));
}

uint32_t VcmLearning::remembered_paths(uint32_t pass, const VcmPlans& plans) {
  return plans.use && teaches_emission(pass) ? LightPathUse::most_paths : 0;
}

bool VcmLearning::wants_next() const {
  return learns_radii_ || (use_ && teaches_emission(passes_)) ||
         wants_samples(passes_, *first_, settings_) ||
         tries_connections(passes_, *first_, settings_);
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
  sums_.assign(learns_radii_ ? first_->pixels.seen().probes().size() : 0, {});
  use_ = first_->use ? std::make_unique<LightPathUse>(*first_->use) : nullptr;
  samples_ = no_samples_;
  connections_ = no_connections_;
  passes_ = 0;
  epochs_ = {{0, first_}};
}

void VcmLearning::learn(const LightVertices& light, const Samples& samples) {
  samples_.learn(samples.spread, passes_);
  if (tries_connections(passes_, *first_, settings_)) connections_.learn(samples.trial);
  if (learns_radii_) {
    const auto added = RadiusLearning::sums_of(first_->pixels, light, settings_.components);
    for (size_t i = 0; i < added.size(); ++i) sums_[i].add(added[i]);
  }
  if (use_ && teaches_emission(passes_)) use_->learn(light);
  ++passes_;
}

void VcmLearning::spread_samples(VcmPlans& plans, uint32_t epoch) const {
  if (epoch < SampleLearning::least_passes || epoch > SampleLearning::most_passes) return;
  const uint32_t samples = plans.samples_per_pixel;
  SampleLearning::Counts found = samples_.counts(samples);
  const std::shared_ptr<const SampleSpread> before = plans.pixels.spread();
  if (found.of_block.empty()) {
    if (!before) return;
    found.of_block.assign(plans.pixels.seen().probes().size(), samples);
  }
  plans.pixels.set_spread(spread_of(epoch, std::move(found.of_block), before.get(), samples));
}

void VcmLearning::choose_connections(VcmPlans& plans, uint32_t epoch) {
  constexpr uint32_t first = ConnectionLearning::first_pass,
                     end = first + ConnectionLearning::pass_count;
  static_assert(std::has_single_bit(first) && std::has_single_bit(end), "a whole epoch");
  // In the trial light paths are to be kept for its samples, but none of the picture's is
  // connected.
  if (epoch == first) plans.techniques.connections = true;
  if (epoch != end) return;
  const auto scales = plans.merge_scales(plans.pixels.plans(), sqr(pass_radius(1, epoch)));
  const ConnectionLearning::Choice choice = connections_.choice(
      plans.samples_per_pixel,
      rays_beside_camera_paths(plans.pilot->probes, plans.pilot->costs, scales));
  connections_ = no_connections_;
  plans.techniques.connections = !choice.connects.empty();
  if (choice.connects.empty()) {
    plans.decisions.push_back(fmt::format(
        "auto: camera paths are not connected to light paths: everywhere, that would leave {:.2f} "
        "of the variance and take {:.2f} times as long",
        choice.variance_left, choice.time_taken));
    return;
  }
  for (size_t i = 0; i < plans.connects.size(); ++i) {
    const Vec2i of_trial =
        plans.pixels.seen().grid().block(i) / ConnectionLearning::blocks_per_trial;
    plans.connects[i] =
        choice.connects[size_t(of_trial.y) * size_t(choice.blocks.x) + size_t(of_trial.x)];
  }
  plans.decisions.push_back(fmt::format(
      "auto: camera paths are connected to light paths in {:.0f} % of the picture: {:.2g} times "
      "less to do than without, by a trial",
      100 * choice.share, choice.gain));
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
  if (learns_connections(*first_, settings_)) choose_connections(*plans, epoch);
  if (learns_radii_) {
    const float shrinkage = sqr(pass_radius(1, passes_));
    plans->settle(radii_->plans(first_->pixels, sums_, passes_, shrinkage), shrinkage);
  }
  if (learns_samples(*first_, settings_)) spread_samples(*plans, epoch);
  if (use_) plans->guide_by(*use_);
  if (passes_ >= most_guided_passes) use_.reset();
  return epochs_[epoch] = std::move(plans);
}

}  // namespace kaustik
