#pragma once
// The entries of bsdf_types() and texture_types(), one per source file.

#include "kaustik/material/bsdf.h"

namespace kaustik {

BsdfType diffuse_type();
BsdfType roughdiffuse_type();
BsdfType phong_type();
BsdfType ward_type();
BsdfType dielectric_type();
BsdfType roughdielectric_type();
BsdfType thindielectric_type();
BsdfType plastic_type();
BsdfType roughplastic_type();
BsdfType pplastic_type();
BsdfType conductor_type();
BsdfType roughconductor_type();
BsdfType principled_type();
BsdfType principledthin_type();
BsdfType openpbr_type();
BsdfType twosided_type();
BsdfType null_type();
BsdfType thinphong_type();
BsdfType difftrans_type();
BsdfType mask_type();
BsdfType blendbsdf_type();
BsdfType mixturebsdf_type();
BsdfType coating_type();
BsdfType roughcoating_type();
BsdfType bumpmap_type();
BsdfType normalmap_type();

TextureType bitmap_type();
TextureType checkerboard_type();
TextureType gridtexture_type();
TextureType scale_type();
TextureType mesh_attribute_type();
TextureType volume_texture_type();
TextureType noise_type();
TextureType marble_type();
TextureType wood_type();
TextureType tiles_type();
TextureType waves_type();

}  // namespace kaustik
