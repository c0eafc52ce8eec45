#pragma once
#include <memory>

#include "kaustik/material/albedo_table.h"
#include "kaustik/material/microfacet.h"

namespace kaustik {

/// Facets by Burley's parameters ("Physically Based Shading at Disney", 2012): GGX with a mean
/// roughness alpha of roughness², times as long along x as across by the root of
/// 1 − 0.9 anisotropic.
MicrofacetDistribution burley_facets(float roughness, float anisotropic);
/// Whether they are as smooth as these facets get: what they scatter is within a few thousandths of
/// the direction of a mirror.
bool are_smoothest(float roughness, float anisotropic);

/// Directional albedos of such facets, by roughness: what those reflect that are white (lane 0),
/// the part of that which Schlick's approximation adds at grazing angles (lane 1), and what those
/// of glass reflect and transmit (lanes 2 and 3).
struct BurleyAlbedos {
  AlbedoTables from_outside, from_inside;
};
/// `eta`: n_interior/n_exterior. One for all materials that are alike in this.
std::shared_ptr<const BurleyAlbedos> burley_albedos(float eta, float anisotropic);

/// Means over what such facets of metal reflect: of 1, schlick_weight() and lazanyi_weight().
std::shared_ptr<const AlbedoTables> burley_metal_means(float anisotropic);

}  // namespace kaustik
