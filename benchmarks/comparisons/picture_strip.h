#pragma once
#include <vector>

#include "kaustik/image/image.h"

namespace kaustik::bench {

/// A picture of a scene beside others of it, for eyes.
///
/// Above: `pictures`, and at the right `reference`, all brought to what a display shows by the same
/// factor: what 98 % of the reference's pixels stay below becomes white. Below each picture its
/// relative squared error, (x − r)²/(r² + 0.01), mean over the channels, as the colours of viridis
/// from 10⁻⁶ (dark blue) to 1 (yellow), logarithmic; under the reference that scale, from left to
/// right. All must be as large as the reference and have "R", "G", "B". The result holds "R", "G",
/// "B" in [0, 1], display-linear.
Image picture_strip(const std::vector<Image>& pictures, const Image& reference);

}  // namespace kaustik::bench
