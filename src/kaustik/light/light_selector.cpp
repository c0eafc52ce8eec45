#include "kaustik/light/light_tree.h"
#include "kaustik/light/power_distribution.h"

namespace kaustik {
namespace {

/// Up to this many lights are chosen by power alone.
constexpr size_t maximum_by_power = 16;
/// Neither infinite lights nor the others get less than this, whatever their power: what they give
/// to a point has little to do with what they give to the scene's bounding sphere.
constexpr double minimum_group_share = 0.125;

double sum(const std::vector<double>& values) {
  double total = 0;
  for (const double value : values) total += value;
  return total;
}

}  // namespace

/// Either all lights by power, or infinite lights by power and the others by the tree.
struct LightSelector::Impl {
  PowerDistribution by_power;  ///< of all lights, or of the infinite ones
  LightTree tree;
  float power_share = 1;  ///< chance of choosing `by_power` rather than the tree
  std::vector<bool> in_tree;
};

LightSelector::LightSelector(const std::vector<std::unique_ptr<Light>>& lights)
    : impl_(std::make_unique<Impl>()) {
  const bool many = lights.size() > maximum_by_power;
  std::vector<double> by_power(lights.size(), 0.0), in_tree(lights.size(), 0.0);
  std::vector<LightTree::Item> items;
  impl_->in_tree.assign(lights.size(), false);
  for (size_t i = 0; i < lights.size(); ++i) {
    const double power = importance_of(lights[i]->power());
    if (!(power > 0)) continue;
    if (!many || lights[i]->is_infinite()) {
      by_power[i] = power;
    } else {
      in_tree[i] = power;
      impl_->in_tree[i] = true;
      items.push_back({int(i), lights[i]->bounds(), power});
    }
  }
  impl_->by_power = PowerDistribution(by_power);
  if (items.empty()) return;
  impl_->tree = LightTree(std::move(items), lights.size());
  const double share = sum(by_power) / (sum(by_power) + sum(in_tree));
  impl_->power_share =
      impl_->by_power.empty()
          ? 0.0f
          : float(std::clamp(share, minimum_group_share, 1.0 - minimum_group_share));
}

LightSelector::~LightSelector() = default;

LightSelector::Choice LightSelector::choose(const Vec3f& reference, const Vec3f& normal,
                                            float& u) const {
  if (impl_->by_power.empty() && impl_->tree.empty()) return {};
  const float share = impl_->power_share;
  if (u < share) {
    u = rescaled(u, 0.0f, share);
    Choice choice = impl_->by_power.choose(u);
    choice.probability *= share;
    return choice;
  }
  u = rescaled(u, share, 1.0f - share);
  Choice choice = impl_->tree.choose(reference, normal, u);
  choice.probability *= 1.0f - share;
  return choice;
}

float LightSelector::probability(const Vec3f& reference, const Vec3f& normal, int light) const {
  if (light < 0) return 0;
  const float share = impl_->power_share;
  if (!impl_->in_tree[size_t(light)]) return impl_->by_power.probability(light) * share;
  return impl_->tree.probability(reference, normal, light) * (1.0f - share);
}

}  // namespace kaustik
