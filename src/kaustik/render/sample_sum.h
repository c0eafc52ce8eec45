#pragma once
#include "kaustik/render/pass_tiles.h"

namespace kaustik {

/// The film's edge: what comes in lanes becomes RGB here. Adds a sample to a pixel's sums, but not
/// to its count. Returns how many components were not finite and left out.
int add_sample(const SampleSink& sink, PassPixel& sum);

}  // namespace kaustik
