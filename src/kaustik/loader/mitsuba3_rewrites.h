#pragma once
// Objects that Mitsuba 3 lacks, as those that it has.

#include <memory>

#include "kaustik/scene/description.h"

namespace kaustik {

/// `mixturebsdf` as a chain of `blendbsdf`, from the last bsdf backward; what weights lack of 1 is
/// black. The mixture itself where its weights are wrong.
std::shared_ptr<Object> mixture_as_blends(const std::shared_ptr<Object>& mixture);
/// `mixturephase` as a chain of `blendphase`; itself where its weights are wrong, or where there
/// are more phase functions than nest.
std::shared_ptr<Object> mixture_as_phases(const std::shared_ptr<Object>& mixture);

// Each changes the object only where the other terms mean the same light.
/// A `phong` or `ward` that does not shine, and a `roughdiffuse` that is smooth: `diffuse`.
void use_diffuse(Object& bsdf);
/// `difftrans`: `principledthin` that transmits all.
void use_thin_sheet(Object& bsdf);
/// `ext_eta` of metals: eta and k divided by it.
void use_relative_eta(Object& bsdf);
/// Distributions of facets of 0.6: `beckmann`, which Kaustik takes for them.
void use_known_distribution(Object& bsdf);
/// A gamma of 1: `raw`. The same wrap mode along both axes: `wrap_mode`.
void use_bitmap_terms(Object& bitmap);
/// `sigma_s` and `sigma_a`: `sigma_t` and `albedo`.
void use_extinction(Object& medium);
/// `to_world` of what lies in z = 0, where it makes all depths one: Mitsuba 3 inverts it, and the
/// shape stays the same whatever becomes of z.
void give_depth(Object& flat_shape);
/// `telecentric` with a pinhole for its aperture: `orthographic`.
void use_orthographic(Object& sensor);

}  // namespace kaustik
