#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "kaustik/base/vec.h"

namespace kaustik {

/// How much of the irradiance that lights are expected to give really arrives, region by region:
/// most lights of a building are behind some wall. Learned from probes on what paths meet, for
/// choosing among lights; it changes no mean.
class LightVisibility {
 public:
  /// Where it was asked what arrives.
  struct Probe {
    Vec3f position;
    Vec3f normal;  ///< unit, on the side that receives
  };

  LightVisibility() = default;
  /// For each probe a row of `lights` numbers: the irradiance expected without shadows
  /// (Light::expected_irradiance) and what one sample of the light found, both by the same unit.
  LightVisibility(const std::vector<Probe>& probes, size_t lights,
                  const std::vector<float>& expected, const std::vector<float>& found);

  bool empty() const { return nodes_.empty(); }
  /// By light, the root of the share that arrives, by which a light is best chosen, in (0, 1].
  /// Negative where no probe has found any of it: its size is only a guess then. Null where no
  /// probe is known that faces a like way. `normal`: as of a LightQuery.
  const float* shares(const Vec3f& reference, const Vec3f& normal) const;

 private:
  struct Node {
    float split;
    int32_t axis;    ///< −1: a leaf
    uint32_t first;  ///< the left child, the right one follows; of leaves the first share
  };
  struct Learning;
  void build(const Learning& from, uint32_t node, std::vector<uint32_t>& probes, size_t begin,
             size_t end);
  void add_leaf(const Learning& from, Node& node, const uint32_t* begin, const uint32_t* end);

  /// One tree for each way that normals mostly point to (±x, ±y, ±z), and one of all probes.
  static constexpr size_t tree_count = 7;
  static size_t tree_of(const Vec3f& normal);

  std::array<int32_t, tree_count> roots_{};  ///< −1: no probe
  std::vector<Node> nodes_;
  std::vector<float> shares_;
};

}  // namespace kaustik
