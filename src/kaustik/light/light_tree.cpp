#include "kaustik/light/light_tree.h"

#include "kaustik/light/light_tree_build.h"
#include "kaustik/light/power_distribution.h"

namespace kaustik {
namespace {

/// A child that may light the point keeps at least this share of its parent's chance.
constexpr float minimum_share = 1.0f / 1024;
/// Rounding of directions must not hide a light at the border of its cone.
constexpr float cosine_slack = 1e-4f;
/// A surface's normal alone never excludes a light: a shading normal may face what the geometric
/// one does not.
constexpr float minimum_receiver_cosine = 0.02f;

/// cos max(0, a − b) of angles within [0, π].
float cos_of_difference(float cos_a, float sin_a, float cos_b, float sin_b) {
  return cos_a > cos_b ? 1.0f : cos_a * cos_b + sin_a * sin_b;
}
/// sin max(0, a − b).
float sin_of_difference(float cos_a, float sin_a, float cos_b, float sin_b) {
  return cos_a > cos_b ? 0.0f : sin_a * cos_b - cos_a * sin_b;
}

}  // namespace

LightTree::LightTree(std::vector<Item> items, size_t light_count) : paths_(light_count) {
  if (items.empty()) return;
  const LightTreeBuild build(std::move(items));
  const double scale = 1.0 / build.nodes().front().intensity;
  for (const LightTreeBuild::Node& from : build.nodes()) {
    Node node;
    node.center = center(from.position);
    node.radius = bounding_radius(from.position) * (1.0f + 1e-5f);
    node.axis = from.emission.axis;
    node.cos_spread = float(std::cos(from.emission.spread));
    node.sin_spread = float(std::sin(from.emission.spread));
    node.cos_falloff = float(std::cos(from.emission.falloff));
    node.intensity = std::max(float(from.intensity * scale), std::numeric_limits<float>::min());
    node.leaf = from.light >= 0;
    node.child = node.leaf ? from.light : from.left;
    if (node.leaf) paths_[size_t(from.light)] = {from.turns, from.depth};
    nodes_.push_back(node);
  }
}

// Conty Estevez and Kulla, eq. 4, for the sphere around the lights, whose angular radius is
// θ_u: intensity · |cos max(0, θ_i − θ_u)| · cos max(0, θ − θ_o − θ_u) / d².
float LightTree::importance(const Node& node, const Vec3f& reference, const Vec3f& normal) {
  const Vec3f to_reference = reference - node.center;
  const float distance_sq = length_sq(to_reference);
  const float radius_sq = sqr(node.radius);
  // Within the sphere a mean distance stands for all: that of points spread evenly over a box from
  // its centre is a third of radius². A quarter gave the least variance, a whole four times that.
  const float base = node.intensity / std::max({distance_sq, 0.25f * radius_sq, 1e-20f});
  if (distance_sq <= radius_sq || distance_sq == 0) return base;

  const Vec3f direction = to_reference * (1.0f / std::sqrt(distance_sq));
  const float sin_u_sq = radius_sq / distance_sq;
  const float sin_u = std::sqrt(sin_u_sq), cos_u = safe_sqrt(1.0f - sin_u_sq);

  const float cos_axis = std::clamp(dot(node.axis, direction), -1.0f, 1.0f);
  const float sin_axis = safe_sqrt(1.0f - sqr(cos_axis));
  const float cos_x = cos_of_difference(cos_axis, sin_axis, node.cos_spread, node.sin_spread);
  const float sin_x = sin_of_difference(cos_axis, sin_axis, node.cos_spread, node.sin_spread);
  const float cos_emission = cos_of_difference(cos_x, sin_x, cos_u, sin_u);
  if (cos_emission < node.cos_falloff - cosine_slack) return 0;

  float cos_receiver = 1;
  if (normal.x != 0 || normal.y != 0 || normal.z != 0) {
    const float cos_i = std::min(abs_dot(normal, direction), 1.0f);
    cos_receiver = std::max(cos_of_difference(cos_i, safe_sqrt(1.0f - sqr(cos_i)), cos_u, sin_u),
                            minimum_receiver_cosine);
  }
  return base * std::max(cos_emission, cosine_slack) * cos_receiver;
}

float LightTree::probability_of_left(const Node& node, const Vec3f& reference,
                                     const Vec3f& normal) const {
  const Node& left = nodes_[size_t(node.child)];
  const Node& right = nodes_[size_t(node.child) + 1];
  float a = importance(left, reference, normal), b = importance(right, reference, normal);
  if (a == 0 && b == 0) {
    // Neither can light the point, which the parent's looser bounds could not tell.
    a = left.intensity;
    b = right.intensity;
  }
  if (a == 0) return 0;
  if (b == 0) return 1;
  return std::clamp(a / (a + b), minimum_share, 1.0f - minimum_share);
}

LightSelector::Choice LightTree::choose(const Vec3f& reference, const Vec3f& normal,
                                        float& u) const {
  float probability = 1;
  const Node* node = &nodes_.front();
  while (!node->leaf) {
    const float left = probability_of_left(*node, reference, normal);
    const bool go_right = !(u < left);
    const float share = go_right ? 1.0f - left : left;
    u = rescaled(u, go_right ? left : 0.0f, share);
    probability *= share;
    node = &nodes_[size_t(node->child) + go_right];
  }
  return {node->child, probability};
}

float LightTree::probability(const Vec3f& reference, const Vec3f& normal, int light) const {
  const Path& path = paths_[size_t(light)];
  if (path.depth < 0) return 0;
  float probability = 1;
  const Node* node = &nodes_.front();
  for (int i = 0; i < path.depth; ++i) {
    const float left = probability_of_left(*node, reference, normal);
    const bool go_right = (path.turns >> i) & 1;
    probability *= go_right ? 1.0f - left : left;
    node = &nodes_[size_t(node->child) + go_right];
  }
  return probability;
}

}  // namespace kaustik
