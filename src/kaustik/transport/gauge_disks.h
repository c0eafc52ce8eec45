#pragma once
#include <array>
#include <vector>

#include "kaustik/scene/scene.h"

namespace kaustik {

/// Disks around the gauges of a scene, which tell of the light that passes them to the side that is
/// measured: its flux over the area of a disk is irradiance. Whatever hides a point of the disk
/// from the gauge ends the disk there. Immutable once built.
class GaugeDisks {
 public:
  GaugeDisks() = default;
  /// Light is collected so far beyond the radius: a wide disk tells of the bias of the other.
  static constexpr float wide_factor = 2;
  /// `radii`, m, of each gauge; 0: none. Looks how much of each disk is in sight of its gauge, and
  /// counts the rays. `turn` in [0, 1) turns the places where it looks. `scene` must outlive this.
  GaugeDisks(const Scene& scene, std::vector<float> radii, float turn, uint64_t& rays);

  /// Of a gauge's disk, by PlacedGauge::distance_around: what is wider would blur too much, m.
  static float largest_radius(float distance_around) { return 0.05f * distance_around; }

  bool empty() const { return numbers_.empty(); }
  float radius(size_t gauge) const { return radii_[gauge]; }
  /// One over the share of the disk, or of the wide one, that is in sight, points being weighed by
  /// 1 − distance²/radius².
  float inverse_share(size_t gauge) const { return inverse_shares_[gauge][0]; }
  float inverse_share_of_wide(size_t gauge) const { return inverse_shares_[gauge][1]; }

  /// Where light passes a disk.
  struct Crossing {
    uint32_t gauge;
    float distance;   ///< from the ray's origin, m
    Vec3f position;   ///< on the disk
    float offset_sq;  ///< from the gauge, m²
  };
  /// visit(crossing) for the wide disks that `ray`, whose direction is unit, passes to the measured
  /// side before `length`; in an order that is always the same.
  template <typename Visit>
  void visit_crossed(const Ray& ray, float length, const Visit& visit) const {
    if (numbers_.empty()) return;
    std::array<uint32_t, 64> stack;
    size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
      const Node& node = nodes_[stack[--depth]];
      if (!meets(node.box, ray, length)) continue;
      if (node.second == 0) {
        for (uint32_t i = node.begin; i < node.end; ++i)
          if (Crossing at; crosses(numbers_[i], ray, length, at)) visit(at);
        continue;
      }
      stack[depth++] = node.second;
      stack[depth++] = uint32_t(&node - nodes_.data()) + 1;
    }
  }

 private:
  /// The first half of a node's disks follows it; `second` is where the other one is, 0: a leaf.
  struct Node {
    Bounds3f box;
    uint32_t second = 0, begin = 0, end = 0;
  };
  const PlacedGauge& gauge(size_t number) const { return scene_->gauges()[number]; }
  Bounds3f bounds_of(uint32_t number) const;
  uint32_t build(uint32_t begin, uint32_t end);
  float wide_radius(size_t number) const { return wide_factor * radii_[number]; }
  float share_in_sight(size_t number, float radius, float turn, uint64_t& rays) const;
  static bool meets(const Bounds3f& box, const Ray& ray, float length);
  bool crosses(uint32_t number, const Ray& ray, float length, Crossing& at) const;

  const Scene* scene_ = nullptr;
  std::vector<float> radii_;
  std::vector<std::array<float, 2>> inverse_shares_;
  std::vector<uint32_t> numbers_;  ///< of the gauges that have disks, in the order of the leaves
  std::vector<Node> nodes_;
};

}  // namespace kaustik
