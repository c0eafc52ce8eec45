#pragma once
#include "kaustik/base/vec.h"

namespace kaustik {

// Fibres that stand up from a surface and shine at grazing angles, for directions on the outer
// side: Conty and Kulla's distribution of normals ("Production Friendly Microfacet Sheen BRDF",
// 2017) with Neubelt and Pettineo's visibility ("Crafting a Next-Gen Material Pipeline for The
// Order: 1886", 2013). Reciprocal; scaled down where fibres so thin would reflect more than
// arrives.

/// f of white fibres; `roughness` from 0, all upright, to 1, dust.
float cloth_fuzz(const Vec3f& wo, const Vec3f& wi, float roughness);
/// Its directional albedo, good to about 10⁻³; at most 1.
float cloth_fuzz_albedo(float cosine, float roughness);

}  // namespace kaustik
