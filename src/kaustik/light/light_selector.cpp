#include <algorithm>
#include <cmath>

#include "kaustik/light/choice_weights.h"
#include "kaustik/light/light_tree.h"

namespace kaustik {
namespace {

/// Up to this many infinite lights are chosen by what each of them may give.
constexpr size_t maximum_few = 16;
static_assert(maximum_few <= LightSelector::maximum_learned);
/// Neither infinite lights nor the others get less than this: what lies between the point and the
/// sky (a room's walls) is not known.
constexpr double minimum_group_share = 0.2;
/// A light that may give anything is chosen at least this often, relative to the best one.
constexpr float minimum_share_of_best = 1.0f / 32;
/// The same where it is known which lights are seen.
constexpr float minimum_learned_share = 1.0f / 256;

/// Some lights, each chosen in proportion to the irradiance that it may give.
class FewLights {
 public:
  FewLights() = default;
  /// As many as ChoiceWeights::most at most.
  FewLights(const std::vector<const Light*>& lights, std::vector<int> indices) {
    const auto ball_of = [&](int index) -> const std::optional<EmissionBall>& {
      return lights[size_t(index)]->traits().ball;
    };
    const auto others = std::stable_partition(
        indices.begin(), indices.end(), [&](int index) { return ball_of(index).has_value(); });
    std::vector<EmissionBall> balls;
    for (auto i = indices.begin(); i != others; ++i) balls.push_back(*ball_of(*i));
    block_ = balls_.add(balls);
    for (const int index : indices) lights_.push_back({index, lights[size_t(index)]});
  }
  size_t size() const { return lights_.size(); }
  bool empty() const { return lights_.empty(); }

  /// `shares`: of what is expected of each light of the scene, LightVisibility::shares(); null: all
  /// of it.
  void weigh(const LightQuery& query, const float* shares, ChoiceWeights& weights) const {
    float* w = weights.values();
    const size_t count = lights_.size();
    balls_.irradiance(block_, query.reference, query.normal, w);
    for (size_t i = block_.count; i < count; ++i)
      w[i] = std::max(0.0f, lights_[i].light->expected_irradiance(query));
    std::fill(w + count, w + EmissionBalls::padded(count), 0.0f);
    if (shares) weigh_by(shares, w);
    weights.raise(count, shares ? minimum_learned_share : minimum_share_of_best);
    if (weights.sum() > 0) return;
    // Where none gives anything it does not matter which is chosen.
    std::array<float, ChoiceWeights::most> alike{};
    std::fill_n(alike.begin(), count, 1.0f);
    weights.replace(count, alike.data());
  }
  LightSelector::Choice choose(const ChoiceWeights& weights, float& u) const {
    const size_t i = weights.choose(lights_.size(), u);
    return {lights_[i].index, weights.probability(i)};
  }
  float probability(const ChoiceWeights& weights, int light) const {
    for (size_t i = 0; i < lights_.size(); ++i)
      if (lights_[i].index == light) return weights.probability(i);
    return 0;
  }

 private:
  /// What no probe has found gets no more than the best of what probes have: of the sun so much is
  /// expected that it would be chosen most often in rooms that it never comes to.
  void weigh_by(const float* shares, float* w) const {
    float best = 0, best_guess = 0;
    for (size_t i = 0; i < lights_.size(); ++i) {
      const float share = shares[lights_[i].index];
      w[i] *= std::fabs(share);
      float& best_of_kind = share > 0 ? best : best_guess;
      best_of_kind = std::max(best_of_kind, w[i]);
    }
    if (!(best > 0 && best_guess > best)) return;
    for (size_t i = 0; i < lights_.size(); ++i)
      if (shares[lights_[i].index] < 0) w[i] = std::min(w[i], best);
  }

  struct Member {
    int index;
    const Light* light;
  };
  std::vector<Member> lights_;  ///< those that are balls come first
  EmissionBalls balls_;
  EmissionBalls::Block block_;
};

/// The weights at one point, and the share of the infinite lights.
struct GroupWeights {
  ChoiceWeights infinite, local;
  float infinite_share;
};

}  // namespace

struct LightSelector::Impl {
  FewLights infinite;
  PowerDistribution infinite_by_power;  ///< of very many infinite lights
  LightTree tree;                       ///< of all lights that have a place
  double infinite_power = 0, local_power = 0;
  std::vector<bool> is_infinite;
  FewLights learned;           ///< all that have power, if they are few enough to learn about
  LightVisibility visibility;  ///< empty: not learned

  /// What is known of the lights' shares; null: nothing.
  const float* shares(const LightQuery& query) const {
    return visibility.empty() ? nullptr : visibility.shares(query.reference, query.normal);
  }
  bool any_infinite() const { return !infinite.empty() || !infinite_by_power.empty(); }

  void weigh(const LightQuery& query, GroupWeights& w) const {
    if (!infinite.empty()) infinite.weigh(query, nullptr, w.infinite);
    if (!tree.empty()) tree.weigh(query, w.local);
    w.infinite_share = share_of_infinite(w);
  }
  float share_of_infinite(const GroupWeights& w) const {
    if (tree.empty() || !any_infinite()) return tree.empty() ? 1.0f : 0.0f;
    double a = infinite_power, b = local_power;
    if (!infinite.empty()) {
      a = double(w.infinite.sum());
      b = tree.expected_irradiance(w.local);
      if (a == 0 || b == 0) return b == 0 ? 1.0f : 0.0f;
    }
    return float(std::clamp(a / (a + b), minimum_group_share, 1.0 - minimum_group_share));
  }
  Choice choose(const LightQuery& query, const GroupWeights& w, float& u) const {
    const float share = w.infinite_share;
    Choice choice;
    if (u < share) {
      u = rescaled(u, 0.0f, share);
      choice = infinite.empty() ? infinite_by_power.choose(u) : infinite.choose(w.infinite, u);
      choice.probability *= share;
    } else {
      u = rescaled(u, share, 1.0f - share);
      choice = tree.choose(query, w.local, u);
      choice.probability *= 1.0f - share;
    }
    return choice;
  }
  float probability(const LightQuery& query, const GroupWeights& w, int light) const {
    if (!is_infinite[size_t(light)])
      return tree.empty() ? 0.0f
                          : (1.0f - w.infinite_share) * tree.probability(query, w.local, light);
    return w.infinite_share * (infinite.empty() ? infinite_by_power.probability(light)
                                                : infinite.probability(w.infinite, light));
  }
};

LightSelector::LightSelector() : impl_(std::make_unique<Impl>()) {}

std::unique_ptr<LightSelector> LightSelector::unlearned_copy() const {
  std::unique_ptr<LightSelector> copy(new LightSelector());
  *copy->impl_ = *impl_;
  copy->impl_->visibility = {};
  copy->only_choice_ = only_choice_;
  return copy;
}

void LightSelector::build(const std::vector<const Light*>& lights) {
  std::vector<double> infinite_powers(lights.size(), 0.0);
  std::vector<int> shining, infinite;
  std::vector<LightTree::Item> items;
  for (size_t i = 0; i < lights.size(); ++i) {
    const Light& light = *lights[i];
    impl_->is_infinite.push_back(light.is_infinite());
    const double power = importance_of(light.traits().power);
    if (!(power > 0)) continue;
    shining.push_back(int(i));
    if (light.is_infinite()) {
      infinite.push_back(int(i));
      impl_->infinite_power += infinite_powers[i] = power;
    } else {
      const LightTraits& traits = light.traits();
      items.push_back({int(i), traits.bounds, power, traits.ball ? &*traits.ball : nullptr});
      impl_->local_power += power;
    }
  }
  if (infinite.size() <= maximum_few)
    impl_->infinite = FewLights(lights, infinite);
  else
    impl_->infinite_by_power = PowerDistribution(infinite_powers);
  impl_->tree = LightTree(std::move(items), lights.size());
  if (shining.empty()) only_choice_ = Choice();
  if (shining.size() == 1) only_choice_ = {shining.front(), 1.0f};
  if (shining.size() <= maximum_learned) impl_->learned = FewLights(lights, shining);
}

LightSelector::~LightSelector() = default;

bool LightSelector::can_learn() const { return impl_->learned.size() > 1; }

void LightSelector::learn(LightVisibility visibility) {
  if (can_learn()) impl_->visibility = std::move(visibility);
}

void LightSelector::choose(const Vec3f& reference, const Vec3f& normal, std::span<float> u,
                           Choice* choices) const {
  if (only_choice_) {
    std::fill_n(choices, u.size(), *only_choice_);
    return;
  }
  const LightQuery query(reference, normal);
  if (const float* shares = impl_->shares(query)) {
    ChoiceWeights w;
    impl_->learned.weigh(query, shares, w);
    for (size_t i = 0; i < u.size(); ++i) choices[i] = impl_->learned.choose(w, u[i]);
    return;
  }
  GroupWeights w;
  impl_->weigh(query, w);
  for (size_t i = 0; i < u.size(); ++i) choices[i] = impl_->choose(query, w, u[i]);
}

float LightSelector::probability(const Vec3f& reference, const Vec3f& normal, int light) const {
  if (light < 0) return 0;
  if (only_choice_) return light == only_choice_->light ? 1.0f : 0.0f;
  const LightQuery query(reference, normal);
  if (const float* shares = impl_->shares(query)) {
    ChoiceWeights w;
    impl_->learned.weigh(query, shares, w);
    return impl_->learned.probability(w, light);
  }
  GroupWeights w;
  impl_->weigh(query, w);
  return impl_->probability(query, w, light);
}

}  // namespace kaustik
