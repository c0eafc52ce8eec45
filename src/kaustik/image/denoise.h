#pragma once
#include "kaustik/image/image.h"

namespace kaustik {

/// Whether the image has the layers that denoise() needs: a component of the light, "albedo", "N"
/// and "depth", not zero everywhere as without camera rays.
bool can_denoise(const Image& image);

/// The picture ("R", "G", "B") with its noise smoothed within what is seen to be one surface, made
/// from the layers of a rendered image: docs/theory/denoising.md. Each component of the light by
/// itself where the image knows two halves of its passes ("odd": what the odd replicates have);
/// else what surfaces scatter and what they mirror or transmit, by "noise.scattered" and
/// "noise.mirrored" or, without them, by the pixels around. Light that surfaces scatter diffusely
/// is divided by their albedo, but not in pictures of irradiance. What they emit stays.
///
/// A blend with the picture as it was rendered, of least error as far as that can be told. With
/// halves "denoised_error" is added: its standard error per channel, without what the integrator
/// tells of its own bias. All other channels stay as they are, so the layers still add up to the
/// picture as it was rendered; "denoised" is set in the metadata. Values that are not finite count
/// as 0. Throws Error(input) unless can_denoise(), and if the image has been denoised: its layers
/// still have the noise that its picture lacks.
Image denoise(const Image& image);

}  // namespace kaustik
