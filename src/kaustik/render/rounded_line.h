#pragma once
#include <array>

#include "kaustik/transport/picture_tiles.h"

namespace kaustik {

/// Rounds what errors are computed from before it is summed, so that exact sums take few bytes: one
/// number of all pixels of a tile in one pass becomes whole multiples of a power of two, `bits`
/// binary places below the geometric mean of those that are not zero. A number of that size keeps
/// so many significant bits and one more, larger ones keep more. What comes out depends on nothing
/// but this pass, so sums are the same in any order of passes. All must be finite.
/// Larger than 2^(51 − bits) times that mean, they keep at least 50 significant bits.
template <typename Number>
void round_line(std::array<Number, PictureTiles::pixels>& values, int bits);

// For the numbers of a film that only errors are computed from. Of a square that has to be enough
// to tell, less a mean's square, a variance; estimates of the bias are noise for the most part.
// Halves of the light tell by how much they differ.
inline constexpr int luminance_bits = 22, square_bits = 40, sample_bits = 24, bias_bits = 20,
                     half_bits = 12;

}  // namespace kaustik
