#pragma once
#include "kaustik/base/vec.h"

namespace kaustik {

/// The broad lobes of Burley, "Physically Based Shading at Disney" (2012) and "Extending the Disney
/// BRDF to a BSDF with Integrated Subsurface Scattering" (2015), for directions on the outer side.
/// All are reciprocal. Of colour and weights the caller knows.

/// π f of a matt base that throws light back where it came from the more, the rougher it is. With
/// `flatness` of 1 it looks like skin or wax instead: light that has travelled a little inside.
float burley_base(const Vec3f& wo, const Vec3f& wi, float roughness, float flatness);
/// Its directional albedo: exact without flatness, else good to 10⁻³.
float burley_base_albedo(float cosine, float roughness, float flatness);

/// f of the shine of cloth at grazing angles.
float burley_sheen(const Vec3f& wo, const Vec3f& wi);
/// Its directional albedo, good to 10⁻³.
float burley_sheen_albedo(float cosine);

}  // namespace kaustik
