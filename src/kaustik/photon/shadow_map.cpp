#include "kaustik/photon/shadow_map.h"

namespace kaustik {

void ShadowVisibility::look() {
  const auto borrowed = scratch_.borrow<SidedTree<ShadowPhoton>::Neighbors>();
  SidedTree<ShadowPhoton>::Neighbors& neighbors = *borrowed;
  std::vector<Counts>& counts = *counts_.emplace(scratch_.list<Counts>());
  const Vec3f& ng = vertex_.point().ng;
  const bool both_sides = vertex_.transmits();
  const SidedTree<ShadowPhoton>& tree = map_->tree();
  tree.nearest(vertex_.position(), both_sides || vertex_.on_front() ? ng : -ng, both_sides,
               settings_.neighbors, settings_.maximum_radius, neighbors);
  for (size_t i = 0; i < neighbors.size(); ++i) {
    const ShadowPhoton& photon = tree.tree().data(neighbors.index(i));
    auto found = std::find_if(counts.begin(), counts.end(),
                              [&](const Counts& c) { return c.light == int(photon.light); });
    if (found == counts.end()) found = counts.insert(found, {int(photon.light), 0, 0});
    ++(photon.shadowed ? found->shadowed : found->lit);
  }
}

VisibilityEstimate sight_of(int lit, int shadowed, bool accurate) {
  if (lit + shadowed == 0) return {};
  const auto total = float(lit + shadowed);
  if (!accurate) return {float(lit) / total, 0};
  // Photons whose fellows disagree, so that a ray has to tell instead of them.
  const int unsure_lit = lit >= 2 && shadowed >= 1 ? lit : 0;
  const int unsure_shadowed = shadowed >= 2 && lit >= 1 ? shadowed : 0;
  return {float(lit - unsure_lit) / total, float(unsure_lit + unsure_shadowed) / total};
}

VisibilityEstimate ShadowVisibility::of(int light) {
  if (!map_ || map_->empty()) return {};
  if (!counts_) look();
  for (const Counts& c : **counts_)
    if (c.light == light) return sight_of(c.lit, c.shadowed, level_ < settings_.accurate_levels);
  return {};
}

}  // namespace kaustik
