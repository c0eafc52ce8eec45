#pragma once
#include <vector>

#include "kaustik/image/image.h"
#include "kaustik/render/film.h"

namespace kaustik {

/// Metadata of a picture that ended within the first pass: the value says what it shows.
inline constexpr const char* incomplete_key = "incomplete";

/// Adds a part of a pass to a film's image, which holds the mean of the passes before. It counts as
/// the share of the pass that was taken, wherever the samples lie: a share that follows from the
/// clock does not bias what they tell. Errors fall as they do with so many passes; their layers say
/// nothing where there is no whole pass.
class PartPicture {
 public:
  /// `share` of the part, 0 to 1, and the replicate of its pass.
  PartPicture(Image& image, double share, uint32_t replicate = 0);
  /// `passes`: that the image holds of the pixel; `mean` of its samples in the part, with its
  /// splats. From any thread.
  void put(int x, int y, const PassPixel& mean, double passes);
  /// Gives the pixel what another one shows.
  void copy(int x, int y, int from_x, int from_y);

 private:
  Image& image_;
  double share_;
  bool is_odd_;               ///< the replicate
  std::vector<int> sources_;  ///< number of the pixel that each channel shows; −1: none
  int odd_share_ = -1;        ///< channel "odd.share"; −1: there is none
};

}  // namespace kaustik
