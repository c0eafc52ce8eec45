#pragma once
// The entries of bsdf_types() and texture_types(), one per source file.

#include "kaustik/material/bsdf.h"

namespace kaustik {

BsdfType diffuse_type();
BsdfType phong_type();
BsdfType dielectric_type();
BsdfType conductor_type();
BsdfType roughconductor_type();
BsdfType twosided_type();
BsdfType null_type();

TextureType bitmap_type();
TextureType checkerboard_type();

}  // namespace kaustik
