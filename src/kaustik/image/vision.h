#pragma once
// What the human eye can and cannot see, as functions of the luminance that it is adapted to. All
// luminances in cd/m².

#include "kaustik/base/vec.h"

namespace kaustik {

/// The smallest difference of luminance that an eye adapted to `adaptation` can see (threshold
/// versus intensity): the lower envelope of rods and cones of Ferwerda et al. 1996, as Ward Larson
/// et al. 1997 put it together (section 4.4). Positive; constant below 1.1e-4 cd/m².
double visible_difference(double adaptation);

/// Finest grating that can be resolved, in cycles per degree: Ward Larson et al. 1997, section
/// 5.3, a fit to Shlaer's data. Its arctangent becomes negative in the dark, so below 1e-6 cd/m²,
/// where nothing is seen, this is the value at 1e-6 (0.76).
double visual_acuity(double adaptation);

/// How much of the colour is seen: 0 below 5.6e-3 cd/m² (rods alone), 1 above 5.6 (cones alone),
/// linear between.
float cone_share(float luminance);

/// The brightness that rods see of a linear Rec. 709 colour, as photopic() for cones: Y [1.33 (1 +
/// (Y + Z) / X) − 1.68] (Ward Larson et al. 1997, section 5.2), over its value for white, so that
/// white has 1. Not negative.
float scotopic(const Vec3f& rgb);

/// The colour seen: grey of the scotopic brightness in the dark, the colour itself in the light.
Vec3f seen_color(const Vec3f& rgb);

}  // namespace kaustik
