#pragma once
// Whether two sets of independent renders have the same expectation, block by block and as a whole.
//
// d_r, the difference of render r of one set and render r of the other, is distributed
// symmetrically about zero where both have the same distribution, and nearly so where both have the
// same expectation: whatever the tails, and however blocks depend on one another, all 2^R ways of
// choosing the signs of the R differences are equally likely. So the sum over blocks of squared
// sums of differences, each over the noise there, is compared with what it is for all other signs.
//
// Some paths are found by rare chance, but then count much. Blocks where all renders have missed
// them know nothing of that noise. So noise is the mean over the blocks around, as a share of their
// light.

#include "tests/agreement/block_samples.h"

namespace kaustik::agreement {

/// Blocks with less light than this part of the picture's mean count together as one. What there is
/// of light in them may be due to so few samples, at the rim of a shadow or in the tail of a
/// pixel's filter, that all renders of a set have missed it and know of no noise. Together they are
/// taken to be as noisy as a block is on the mean.
inline constexpr double dark_share = 0.05;

/// Means over each cell of a square of `columns`² and those that tell of its noise, 3 to every
/// side, of what is lit; 0 where nothing is. Values of what is not lit do not count.
std::vector<double> means_of_lit(std::vector<double> values, const std::vector<bool>& is_lit,
                                 int columns);

/// Chances of such differences, or larger ones, where there is none in truth.
struct Verdict {
  double p_mean = 1;     ///< of the picture's mean, by Student's t
  double p_blocks = 1;   ///< of the sum of squares over all blocks, by flips of signs
  double p_worst = 1;    ///< of the worst block, by Student's t and Šidák over all blocks
  int worst_block = -1;  ///< one beyond the last: the dark ones
  double worst_t = 0;
  double mean_difference = 0;        ///< over the reference's mean
  double mean_difference_error = 0;  ///< its standard error

  /// Of all three tests together.
  bool rejects(double level) const;
};

/// `planted`: relative bias that the tested picture is given besides.
Verdict compare(const Replicates& tested, const Replicates& reference, double planted = 0);

/// The least relative bias of the whole component that compare() would find in these very renders,
/// of either sign; 1: not even that.
double smallest_bias_found(const Replicates& tested, const Replicates& reference, double level);

/// Chance of means that differ as much or more, where they differ by the part `tolerance` of the
/// reference in truth: of the worst block, by Student's t and Šidák.
double p_beyond(const Replicates& tested, const Replicates& reference, double tolerance,
                double planted = 0);

/// The same where the tested renders tell of their own bias, block by block: where in truth the
/// difference of the means is anything between nothing and what is told. So what is told must not
/// be too little, nor of the wrong sign. It is as noisy as the renders, which counts.
double p_beyond_told(const Replicates& tested, const Replicates& reference, const Replicates& told,
                     double planted = 0);

}  // namespace kaustik::agreement
