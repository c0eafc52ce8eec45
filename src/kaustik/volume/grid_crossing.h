#pragma once
#include <algorithm>

#include "kaustik/volume/grid_volume.h"

namespace kaustik {

/// A straight line through a grid of one channel, as a row of pieces within each of which values
/// have bounds. It serves estimates that look at a few places only, where following every cell
/// takes longer; of a single piece the integral is known without error, too. Places on the line are
/// told by how far they are from where it enters the box, m.
class GridCrossing {
 public:
  /// Of origin + t direction, 0 ≤ t ≤ `to` (may be infinite). The grid must outlive it.
  GridCrossing(const GridVolume& grid, const Vec3f& origin, const Vec3f& direction, float to);

  struct Piece {
    float begin, end;      ///< places
    float least, largest;  ///< no value on the piece is less or larger
    float cells;           ///< how many cells the piece is about to cross, one at least
  };
  /// Moves on to the next piece that has a length and values other than 0; false where none is
  /// left. Pieces come in order.
  bool next(Piece& piece);
  /// The t of a place.
  float distance(float place) const { return line_.begin + place; }

  /// One of the samples around a place: the mean over `u`, uniform in [0, 1), is the value there.
  /// What it leaves of `u` is uniform as well. It is asked for, and is there some time later.
  const float* sample(float place, float& u) const;
  float integral(const Piece& piece) const;
  /// The place where the integral from the begin of the piece on comes to `target` ≥ 0, for values
  /// nowhere negative.
  GridVolume::Reach reach(const Piece& piece, float target) const;

 private:
  GridVolume::Line part(const Piece& piece) const;

  const GridVolume& grid_;
  GridVolume::Line line_{};
  float cells_per_length_ = 0;
  float at_ = 0;                                ///< where the next piece begins
  const GridVolume::Bounds* bounds_ = nullptr;  ///< of the region that it is in; null: none is left
  /// What is beyond that region along an axis.
  struct Ahead {
    float enters = infinity;  ///< where the line enters it
    float boundary = 0;       ///< in cells, and how far away the next one is
    float to_boundary = 0;
    int regions = 0;          ///< how many there are
    ptrdiff_t to_bounds = 0;  ///< how far away their bounds are
  };
  Ahead ahead_[3];
};

inline bool GridCrossing::next(Piece& piece) {
  while (bounds_) {
    int axis = ahead_[1].enters < ahead_[0].enters ? 1 : 0;
    axis = ahead_[2].enters < ahead_[axis].enters ? 2 : axis;
    Ahead& ahead = ahead_[axis];
    const float begin = at_;
    const GridVolume::Bounds& bounds = *bounds_;
    at_ = std::max(std::min(ahead.enters, line_.length), begin);
    if (ahead.enters < line_.length && ahead.regions > 0) {
      --ahead.regions;
      bounds_ += ahead.to_bounds;
      ahead.boundary += ahead.to_boundary;
      ahead.enters = (ahead.boundary - line_.at[axis]) * line_.inverse[axis];
    } else {
      bounds_ = nullptr;
    }
    if (at_ > begin && (bounds.least != 0 || bounds.largest != 0)) {
      piece = {begin, at_, bounds.least, bounds.largest, 1 + (at_ - begin) * cells_per_length_};
      return true;
    }
  }
  return false;
}

}  // namespace kaustik
