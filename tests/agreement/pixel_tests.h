#pragma once
// Whether pictures have the expectation of a reference in every single pixel: a test by Student's t
// for each, and Šidák's rule over all. It finds what is wrong in one pixel, which a block's mean
// hides; what is a little wrong everywhere the tests of blocks find (sign_flips.h).

#include "tests/agreement/block_samples.h"

namespace kaustik::agreement {

/// What is kept of a picture's renders, pixel by pixel.
struct PixelMoments {
  std::vector<float> mean;
  /// Standard error of that mean, rounding in the file included.
  std::vector<float> standard_error;
};
/// By the component's name.
using PixelReference = std::map<std::string, PixelMoments>;

PixelReference moments_of(const Components& pixels);

/// An EXR with the size of the picture: means, such as "direct", and their standard errors as a
/// share of them, such as "direct.error", with 16 bits each. Throws Error if a mean is beyond what
/// 16 bits hold.
void write_pixels(const PixelReference& reference, const std::string& path);
/// Throws Error if it is no such file.
PixelReference read_pixels(const std::string& path);

/// Chance that one component fails where all is right: of all pixels together.
inline constexpr double pixel_level = 0.01;

struct PixelVerdict {
  double p_worst = 1;    ///< by Student's t and Šidák over all pixels that count
  int worst_pixel = -1;  ///< row by row
  double worst_t = 0;
  size_t counted = 0;
  /// The relative deviation of one pixel that would be found: in half of the pixels less will do.
  double median_found = 0;
};

/// Of renders of all `columns` × `columns` pixels. The variance of a pixel is its own or the mean
/// of those around, as a share of their light, whichever is larger: of a set of renders that has
/// missed rare bright paths a pixel by itself knows too little. Pixels with less than `dark_share`
/// of the mean light are left to the test of blocks.
PixelVerdict compare_pixels(const Replicates& tested, const PixelMoments& reference, int columns);

}  // namespace kaustik::agreement
