#include "kaustik/light/power_distribution.h"

#include <numeric>

namespace kaustik {

PowerDistribution::PowerDistribution(const std::vector<double>& weights)
    : probability_of_light_(weights.size(), 0.0f) {
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  if (!(total > 0)) return;
  double sum = 0;
  for (size_t i = 0; i < weights.size(); ++i) {
    if (!(weights[i] > 0)) continue;
    sum += weights[i];
    // A weight too small for a float still keeps a chance.
    probability_of_light_[i] =
        std::max(float(weights[i] / total), std::numeric_limits<float>::min());
    lights_.push_back(int(i));
    cumulative_.push_back(float(sum / total));
  }
  cumulative_.back() = 1.0f;
}

LightSelector::Choice PowerDistribution::choose(float& u) const {
  const auto end = std::upper_bound(cumulative_.begin(), cumulative_.end(), u);
  const size_t i = std::min(size_t(end - cumulative_.begin()), lights_.size() - 1);
  const float low = i > 0 ? cumulative_[i - 1] : 0.0f;
  u = rescaled(u, low, cumulative_[i] - low);
  return {lights_[i], probability(lights_[i])};
}

}  // namespace kaustik
