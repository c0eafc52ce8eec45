#pragma once
// The operators that tone_operator_types() lists, one source file each.

#include "kaustik/image/tone_mapping.h"

namespace kaustik {

ToneOperatorType srgb_tone();
ToneOperatorType linear_tone();
ToneOperatorType histogram_tone();
ToneOperatorType reinhard_tone();
ToneOperatorType aces_tone();
ToneOperatorType falsecolor_tone();

/// The pixels, and then the parts.
inline std::vector<Vec3f> with_parts(Picture picture) {
  picture.pixels.insert(picture.pixels.end(), picture.parts.begin(), picture.parts.end());
  return std::move(picture.pixels);
}

/// The row "exposure" that several operators have, in stops.
Parameter exposure_parameter();

}  // namespace kaustik
