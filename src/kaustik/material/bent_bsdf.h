#pragma once
#include "kaustik/material/bsdf.h"

namespace kaustik {

/// The nested bsdf of `inputs` with a relief; all its answers are the nested one's, in the frame
/// that the relief bends. Throws Error(input) if there is a relief already.
std::shared_ptr<const Bsdf> make_bent_bsdf(const BsdfInputs& inputs,
                                           std::unique_ptr<const Relief> relief);

/// The texture `name`. Throws Error(input) if there is none.
std::shared_ptr<const Texture> relief_texture(const BsdfInputs& inputs, const std::string& name);

}  // namespace kaustik
