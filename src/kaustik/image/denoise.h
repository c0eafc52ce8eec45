#pragma once
#include "kaustik/image/image.h"

namespace kaustik {

/// Whether the image has the layers that denoise() needs: a component of the light, "albedo", "N"
/// and "depth", not zero everywhere as without camera rays.
bool can_denoise(const Image& image);

/// The picture ("R", "G", "B") with its noise smoothed within what is seen to be one surface, made
/// from the layers of a rendered image. Light that surfaces scatter diffusely is divided by their
/// albedo (not so in pictures of irradiance) and smoothed apart from what they mirror or transmit;
/// what they emit and what a medium scatters stays. Repeated sparse 5 × 5 averages (an
/// edge-avoiding à-trous transform, Dammertz et al. 2010) over pixels of like normal, albedo, plane
/// and brightness; which brightness is alike is told by the noise (Schied et al. 2017), from
/// "noise.scattered" and "noise.mirrored" or, without them, from the pixels around.
///
/// Biased: details of the light that are fainter than its noise are lost. All other channels stay
/// as they are, so the layers still add up to the picture as it was rendered; "denoised" is set in
/// the metadata. Values that are not finite count as 0. Throws Error(input) unless can_denoise(),
/// and if the image has been denoised: its layers still have the noise that its picture lacks.
Image denoise(const Image& image);

}  // namespace kaustik
