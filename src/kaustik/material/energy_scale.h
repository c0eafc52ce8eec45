#pragma once
#include <vector>

#include "kaustik/material/texture.h"

namespace kaustik {

/// What factors on lobes of albedo 1 are scaled by, so that no more light leaves than arrives:
/// textured ones by the inverse of the largest sum that they might have. Throws Error(input) where
/// constant ones add up to over 1; its message names the colours of the type.
float energy_scale(const std::vector<const Texture*>& factors, const Arguments& arguments);

}  // namespace kaustik
