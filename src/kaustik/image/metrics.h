#pragma once
#include <cstddef>

#include "kaustik/image/image.h"

namespace kaustik {

/// What tells an image from its reference, over "R", "G", "B". Pixels with a value that is not
/// finite in either image are left out of everything and counted.
struct ImageComparison {
  double mse = 0;           ///< mean over pixels and channels of (x − r)²
  double relative_mse = 0;  ///< mean over pixels and channels of (x − r)²/(r² + 0.01)
  /// The same without the worst 0.1 % of the pixels (their number rounded down); a pixel's error is
  /// the mean of its channels.
  double relative_mse_trimmed = 0;
  Vec3d mean;            ///< of the image, per channel
  Vec3d reference_mean;  ///< of the reference
  Vec3d mean_ratio;      ///< mean / reference mean; 1 for 0/0
  size_t pixel_count = 0;
  size_t non_finite_pixels = 0;
};

/// Mean without the largest thousandth of the values (their number rounded down).
double trimmed_mean(std::vector<double> values);

/// The same pixels of two images: both are whole, or windows of one picture, as their frames tell.
struct SamePixels {
  Image image, reference;
};
/// Of two windows of one picture what one has of the other if that lies in it; an image without a
/// frame of its own is taken for the window of its size. Throws Error(input) if neither holds.
SamePixels same_pixels(Image image, Image reference);

/// Throws Error(input) if the sizes differ, an image has no such layer, or no pixel is finite in
/// both.
ImageComparison compare_images(const Image& image, const Image& reference,
                               const std::string& layer = {});

/// What a reference that was rendered adds to relative_mse_trimmed by its own noise, on average:
/// trimmed mean of ε²/(r² + 0.01), where ε is the standard error in the layer "error" of rendered
/// EXRs. Within some hundredths: it trims by what is expected, not by what is. Throws Error(input)
/// if `reference` has no such layer.
double own_relative_mse(const Image& reference);

/// A picture (display-linear "R", "G", "B" in [0, 1]) of (x − r)/(|r| + 0.1), taken of the photopic
/// values: white where both agree, red where the image is brighter, blue where it is darker, fully
/// so at ±`full_scale`; green where a value is not finite. Throws as compare_images() does.
Image difference_image(const Image& image, const Image& reference, float full_scale = 1,
                       const std::string& layer = {});

}  // namespace kaustik
