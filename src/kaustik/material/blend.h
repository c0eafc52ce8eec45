#pragma once
#include "kaustik/material/bsdf.h"

namespace kaustik {

/// Two bsdfs mixed: f = (1 − w) f_0 + w f_1; what the weight says beyond 0 … 1 is taken to its
/// ends. A second one without lobes absorbs its share.
std::shared_ptr<const Bsdf> make_blend(std::shared_ptr<const Bsdf> first,
                                       std::shared_ptr<const Bsdf> second,
                                       std::shared_ptr<const Texture> weight);
/// Throws Error(input) if one of the bsdfs that `inputs` holds has a bump or normal map: each blend
/// has one frame.
void refuse_reliefs_in_blend(const BsdfInputs& inputs);

}  // namespace kaustik
