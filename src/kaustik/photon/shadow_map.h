#pragma once
#include <optional>
#include <vector>

#include "kaustik/base/scratch.h"
#include "kaustik/photon/kd_tree/sided_tree.h"
#include "kaustik/transport/vertex.h"
#include "kaustik/transport/visibility_estimator.h"

namespace kaustik {

/// Where a ray straight from a light met a surface: lit by it at the first one, in its shadow at
/// all that follow along the line (Jensen and Christensen 1995). Its position is the key. 8 bytes.
struct ShadowPhoton {
  CoarseNormal side;     ///< geometric normal on the side that faces the light
  uint8_t on_front = 1;  ///< whether that is the side of the surface's own normal
  uint32_t light : 31 = 0;
  uint32_t shadowed : 1 = 0;
};
static_assert(sizeof(ShadowPhoton) == 8);

/// How shadow photons are asked.
struct ShadowSettings {
  int neighbors = 50;               ///< photons to find, of all lights together
  float maximum_radius = infinity;  ///< m
  /// Recursion levels that send shadow rays where lit and shadowed photons mix (penumbrae); deeper
  /// ones take the share of the lit.
  int accurate_levels = 1;
};

/// Shadow photons of all lights in a kd-tree. Immutable.
class ShadowMap {
 public:
  ShadowMap() = default;
  ShadowMap(std::vector<Vec3f> positions, std::vector<ShadowPhoton> photons)
      : tree_(std::move(positions), std::move(photons)) {}

  size_t size() const { return tree_.size(); }
  bool empty() const { return tree_.empty(); }
  size_t size_in_bytes() const { return tree_.size_in_bytes(); }
  const SidedTree<ShadowPhoton>& tree() const { return tree_; }

 private:
  SidedTree<ShadowPhoton> tree_;
};

/// What `lit` and `shadowed` photons of a light say: all of one kind decide; where they mix, a
/// shadow ray does (`accurate`), or else the share of the lit. A photon that all the others
/// contradict still has its say of 1/n: without it the accurate solution is too sure of itself (it
/// makes p + pⁿ(1 − p) − (1 − p)ⁿp of the visibility p, however many photons there are).
/// With it each photon decides where the others agree, and they are independent of it: the mean is
/// p.
VisibilityEstimate sight_of(int lit, int shadowed, bool accurate);

/// What the shadow photons near a vertex say of the lights there. They are looked up at the first
/// question. Biased as far as visibility varies within the search radius, and only so far.
class ShadowVisibility final : public VisibilityEstimator {
 public:
  /// `map` null: nothing is known. All must outlive this.
  ShadowVisibility(const ShadowMap* map, const ShadowSettings& settings,
                   const SurfaceVertex& vertex, int level, Scratch& scratch)
      : map_(map), settings_(settings), vertex_(vertex), level_(level), scratch_(scratch) {}

  /// Of a light without photons nearby nothing is known.
  VisibilityEstimate of(int light) override;

 private:
  struct Counts {
    int light = -1, lit = 0, shadowed = 0;
  };
  void look();

  const ShadowMap* map_;
  const ShadowSettings& settings_;
  const SurfaceVertex& vertex_;
  int level_;
  Scratch& scratch_;
  std::optional<Scratch::List<Counts>> counts_;  ///< of lights with photons nearby; none: not asked
};

}  // namespace kaustik
