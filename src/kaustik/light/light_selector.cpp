#include <algorithm>

#include "kaustik/light/emission_ball.h"
#include "kaustik/light/light_tree.h"
#include "kaustik/light/power_distribution.h"

namespace kaustik {
namespace {

/// Up to this many lights of a group are chosen by what each of them may give.
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
  struct Weights {
    std::array<float, LightSelector::maximum_learned> of;  ///< only as many as there are lights
    float sum = 0;  ///< of the irradiances, before the least ones are raised
    float total = 0;
  };

  void add(int index, const Light& light) {
    // Those that are balls come first.
    const EmissionBall* ball = light.emission_ball();
    const auto place = ball ? std::ptrdiff_t(balls_.size()) : std::ptrdiff_t(lights_.size());
    lights_.insert(lights_.begin() + place, {index, &light});
    if (ball) balls_.add(*ball);
  }
  size_t size() const { return lights_.size(); }
  bool empty() const { return lights_.empty(); }

  /// `shares`: of what is expected of each light of the scene; null: all of it.
  Weights weights(const LightQuery& query, const float* shares = nullptr) const {
    const float least = shares ? minimum_learned_share : minimum_share_of_best;
    Weights w;
    float best = 0;
    balls_.irradiance(query.reference, query.normal, w.of.data());
    for (size_t i = balls_.size(); i < lights_.size(); ++i)
      w.of[i] = lights_[i].light->expected_irradiance(query);
    for (size_t i = 0; i < lights_.size(); ++i) {
      w.of[i] = std::max(0.0f, w.of[i]);
      if (shares) w.of[i] *= shares[lights_[i].index];
      w.sum += w.of[i];
      best = std::max(best, w.of[i]);
    }
    for (size_t i = 0; i < lights_.size(); ++i) {
      // Where none gives anything it does not matter which is chosen.
      if (w.of[i] > 0) w.of[i] = std::max(w.of[i], best * least);
      if (!(best > 0)) w.of[i] = 1;
      w.total += w.of[i];
    }
    return w;
  }
  LightSelector::Choice choose(const Weights& w, float& u) const {
    const float target = u * w.total;
    float low = 0;
    size_t chosen = 0;
    for (size_t i = 0; i < lights_.size(); ++i) {
      if (!(w.of[i] > 0)) continue;
      chosen = i;
      if (target < low + w.of[i]) break;
      if (i + 1 < lights_.size()) low += w.of[i];
    }
    u = rescaled(target, low, w.of[chosen]);
    return {lights_[chosen].index, w.of[chosen] / w.total};
  }
  float probability(const Weights& w, int light) const {
    for (size_t i = 0; i < lights_.size(); ++i)
      if (lights_[i].index == light) return w.of[i] / w.total;
    return 0;
  }

 private:
  struct Member {
    int index;
    const Light* light;
  };
  std::vector<Member> lights_;
  EmissionBalls balls_;  ///< of the first lights
};

/// Lights of one kind, infinite or with a place: few of them by what they may give, many by their
/// power or by the tree.
struct Group {
  FewLights few;
  PowerDistribution by_power;
  LightTree tree;
  double power = 0;

  bool empty() const { return few.empty() && by_power.empty() && tree.empty(); }
};

}  // namespace

struct LightSelector::Impl {
  Group infinite, local;
  std::vector<bool> is_infinite;
  int only_light = -1;         ///< the one that has power, if there is one alone
  FewLights learned;           ///< all that have power, if they are few enough to learn about
  LightVisibility visibility;  ///< empty: not learned

  /// What is known of the lights' shares; null: nothing.
  const float* shares(const Vec3f& reference, const Vec3f& normal) const {
    return visibility.empty() ? nullptr : visibility.shares(reference, normal);
  }

  void add_infinite(const std::vector<std::unique_ptr<Light>>& lights);
  void add_local(const std::vector<std::unique_ptr<Light>>& lights);
};

/// The weights of both groups at one point, and the share of the infinite one.
struct GroupWeights {
  FewLights::Weights infinite, local;
  float infinite_share;
};

namespace {

GroupWeights weigh(const Group& infinite, const Group& local, const LightQuery& query) {
  GroupWeights w;
  w.infinite = infinite.few.weights(query);
  w.local = local.few.weights(query);
  if (infinite.empty() || local.empty()) {
    w.infinite_share = local.empty() ? 1.0f : 0.0f;
    return w;
  }
  const bool both_few = !infinite.few.empty() && !local.few.empty();
  const double a = both_few ? double(w.infinite.sum) : infinite.power;
  const double b = both_few ? double(w.local.sum) : local.power;
  if (both_few && (a == 0 || b == 0)) {
    w.infinite_share = b == 0 ? 1.0f : 0.0f;
    return w;
  }
  w.infinite_share = float(std::clamp(a / (a + b), minimum_group_share, 1.0 - minimum_group_share));
  return w;
}

LightSelector::Choice choose_by_group(const Group& infinite, const Group& local,
                                      const GroupWeights& w, const Vec3f& reference,
                                      const Vec3f& normal, float& u) {
  const float share = w.infinite_share;
  LightSelector::Choice choice;
  if (u < share) {
    u = rescaled(u, 0.0f, share);
    choice =
        infinite.few.empty() ? infinite.by_power.choose(u) : infinite.few.choose(w.infinite, u);
    choice.probability *= share;
  } else {
    u = rescaled(u, share, 1.0f - share);
    choice =
        local.few.empty() ? local.tree.choose(reference, normal, u) : local.few.choose(w.local, u);
    choice.probability *= 1.0f - share;
  }
  return choice;
}

}  // namespace

void LightSelector::Impl::add_infinite(const std::vector<std::unique_ptr<Light>>& lights) {
  std::vector<double> powers(lights.size(), 0.0);
  for (size_t i = 0; i < lights.size(); ++i)
    if (lights[i]->is_infinite()) infinite.power += powers[i] = importance_of(lights[i]->power());
  const auto shining =
      size_t(std::count_if(powers.begin(), powers.end(), [](double p) { return p > 0; }));
  if (shining > maximum_few) {
    infinite.by_power = PowerDistribution(powers);
    return;
  }
  for (size_t i = 0; i < lights.size(); ++i)
    if (powers[i] > 0) infinite.few.add(int(i), *lights[i]);
}

void LightSelector::Impl::add_local(const std::vector<std::unique_ptr<Light>>& lights) {
  std::vector<LightTree::Item> items;
  for (size_t i = 0; i < lights.size(); ++i) {
    const double power = importance_of(lights[i]->power());
    if (lights[i]->is_infinite() || !(power > 0)) continue;
    items.push_back({int(i), lights[i]->bounds(), power});
    local.power += power;
  }
  if (items.size() > maximum_few)
    local.tree = LightTree(std::move(items), lights.size());
  else
    for (const LightTree::Item& item : items)
      local.few.add(item.light, *lights[size_t(item.light)]);
}

LightSelector::LightSelector(const std::vector<std::unique_ptr<Light>>& lights)
    : impl_(std::make_unique<Impl>()) {
  for (const auto& light : lights) impl_->is_infinite.push_back(light->is_infinite());
  impl_->add_infinite(lights);
  impl_->add_local(lights);
  int shining = 0;
  for (size_t i = 0; i < lights.size(); ++i) {
    if (!(importance_of(lights[i]->power()) > 0)) continue;
    impl_->only_light = ++shining == 1 ? int(i) : -1;
    if (size_t(shining) <= maximum_learned) impl_->learned.add(int(i), *lights[i]);
  }
  if (size_t(shining) > maximum_learned) impl_->learned = {};
}

LightSelector::~LightSelector() = default;

bool LightSelector::can_learn() const { return impl_->learned.size() > 1; }

void LightSelector::learn(LightVisibility visibility) {
  if (can_learn()) impl_->visibility = std::move(visibility);
}

void LightSelector::choose(const Vec3f& reference, const Vec3f& normal, std::span<float> u,
                           Choice* choices) const {
  const Group &infinite = impl_->infinite, &local = impl_->local;
  if (impl_->only_light >= 0 || (infinite.empty() && local.empty())) {
    const bool one = impl_->only_light >= 0;
    std::fill_n(choices, u.size(), one ? Choice{impl_->only_light, 1.0f} : Choice());
    return;
  }
  if (const float* shares = impl_->shares(reference, normal)) {
    const FewLights::Weights w = impl_->learned.weights({reference, normal}, shares);
    for (size_t i = 0; i < u.size(); ++i) choices[i] = impl_->learned.choose(w, u[i]);
    return;
  }
  const GroupWeights w = weigh(infinite, local, {reference, normal});
  for (size_t i = 0; i < u.size(); ++i)
    choices[i] = choose_by_group(infinite, local, w, reference, normal, u[i]);
}

float LightSelector::probability(const Vec3f& reference, const Vec3f& normal, int light) const {
  if (light < 0) return 0;
  if (impl_->only_light >= 0) return light == impl_->only_light ? 1.0f : 0.0f;
  const Group &infinite = impl_->infinite, &local = impl_->local;
  if (infinite.empty() && local.empty()) return 0;
  if (const float* shares = impl_->shares(reference, normal))
    return impl_->learned.probability(impl_->learned.weights({reference, normal}, shares), light);
  const GroupWeights w = weigh(infinite, local, {reference, normal});
  if (impl_->is_infinite[size_t(light)])
    return w.infinite_share * (infinite.few.empty() ? infinite.by_power.probability(light)
                                                    : infinite.few.probability(w.infinite, light));
  return (1.0f - w.infinite_share) * (local.few.empty()
                                          ? local.tree.probability(reference, normal, light)
                                          : local.few.probability(w.local, light));
}

}  // namespace kaustik
