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

/// The row "exposure" that several operators have, in stops.
Parameter exposure_parameter();

}  // namespace kaustik
