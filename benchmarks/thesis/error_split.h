#pragma once
#include <span>
#include <string>

#include "kaustik/image/image.h"

namespace kaustik::thesis {

/// Relative mean square error of one picture, told apart by pictures of several seeds: what
/// changes from seed to seed, and what does not. Without the worst 0.1 % of the pixels.
struct ErrorSplit {
  double noise = 0, bias = 0;
  double sum() const { return noise + bias; }
};

/// `pictures`: at least two, of different seeds. `layer` of all, "" for the picture itself. The
/// squared bias is estimated without the noise of the pictures' mean, so it may come out below
/// zero.
ErrorSplit split_error(std::span<const Image> pictures, const Image& reference,
                       const std::string& layer = {});

}  // namespace kaustik::thesis
