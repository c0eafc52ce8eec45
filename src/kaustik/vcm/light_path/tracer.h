#pragma once
#include "kaustik/vcm/light_pass.h"
#include "kaustik/vcm/light_path/block.h"

namespace kaustik {

/// Traces the light paths `begin` to `end`: keeps their vertices, and splats them where that is one
/// of the techniques.
LightBlock trace_light_block(const VcmLightInputs& inputs, const Pass& pass, Stream stream,
                             SplatBuffer& splats, uint32_t begin, uint32_t end);

}  // namespace kaustik
