#include "kaustik/photon/drawn_photons.h"

#include <algorithm>

namespace kaustik {
namespace {

/// Lists are shortened when they are so many times as long as what is wanted, and so much more.
constexpr size_t slack_factor = 2, slack = 4096;

bool has_less_key(const PhotonDraw::Offer& a, const PhotonDraw::Offer& b) { return a.key < b.key; }

}  // namespace

void PhotonDraw::offer(const std::vector<Offer>& offers) {
  const std::lock_guard lock(mutex_);
  total_ += offers.size();
  for (const Offer& offer : offers) {
    kept_.push_back(offer);
    if (kept_.size() > slack_factor * most_ + slack) keep_least();
  }
}

void PhotonDraw::keep_least() {
  if (kept_.size() <= most_) return;
  const auto end = kept_.begin() + std::ptrdiff_t(most_);
  std::nth_element(kept_.begin(), end, kept_.end(), has_less_key);
  kept_.erase(end, kept_.end());
}

DrawnPhotons PhotonDraw::take() {
  const std::lock_guard lock(mutex_);
  keep_least();
  std::sort(kept_.begin(), kept_.end(), has_less_key);
  DrawnPhotons drawn;
  drawn.total = total_;
  drawn.photons.reserve(kept_.size());
  for (const Offer& offer : kept_) drawn.photons.push_back(offer.photon);
  kept_.clear();
  return drawn;
}

}  // namespace kaustik
