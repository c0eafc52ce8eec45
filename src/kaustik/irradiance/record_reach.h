#pragma once
#include "kaustik/irradiance/cache_record.h"
#include "kaustik/irradiance/hemisphere.h"

namespace kaustik {

/// From how far away a record's irradiance may be taken is told by a length R, its radius of
/// validity: with the quality a the record serves within a R, at a right angle to `axis` within
/// `aspect` times as much.
struct Validity {
  float radius = infinity;  ///< m
  float aspect = 1;         ///< ≥ 1
  Vec3f axis{0, 0, 0};      ///< unit, in the tangent plane; zero while `aspect` is 1
};

/// Ward, Rubinstein and Clear 1988: the scene as a sphere split into a bright and a dark half. R is
/// the harmonic mean distance of what the record sees, or the minimum; with gradients at most the
/// length over which they would change the irradiance by itself.
float split_sphere_radius(const HemisphereEstimate& estimate, bool minimum_distance);
float gradient_radius(const HemisphereEstimate& estimate);
/// The same for turned normals: square of √2 over the angle by which the rotation gradient would
/// change the irradiance by itself, at least 1. Without it records serve within √2 times the
/// quality, in radians.
float turning_factor(const HemisphereEstimate& estimate);

/// Schwarzhaupt, Jensen and Jarosz 2012: by the Hessian of the irradiance, which is what gradients
/// leave out. The relative error ½ |Δxᵀ H Δx|/E is integrated over an ellipse whose rim has the
/// same error everywhere, in units of the area `pixel_width`² of a pixel: records allow for equal
/// shares of the picture's error where this total is the same. Here R is the shorter radius for
/// which it is `total_error_scale`; since it grows with the fourth power of the radius, the quality
/// a allows a⁴ times as much, and the number of records goes as 1/a² in both metrics. Lanes count
/// by the root of the sum of their squares.
Validity hessian_validity(const HemisphereEstimate& estimate, const Vec3f& normal,
                          float pixel_width);
inline constexpr float total_error_scale = 200;
/// No ellipse is longer: Hessians are noisy, and so are gradients over long ways (4 is worse in the
/// measurements of docs/thesis/irradiance_cache.md).
inline constexpr float greatest_aspect = 2;

}  // namespace kaustik
