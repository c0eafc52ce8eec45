#pragma once
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

  /// The value at a place of the piece, within its bounds.
  float value(const Piece& piece, float place) const;
  float integral(const Piece& piece) const;
  /// The place where the integral from the begin of the piece on comes to `target` ≥ 0, for values
  /// nowhere negative.
  GridVolume::Reach reach(const Piece& piece, float target) const;

 private:
  GridVolume::Line part(const Piece& piece) const;

  const GridVolume& grid_;
  GridVolume::Line line_{};
  float at_ = 0;  ///< where the next piece begins
  bool is_over_ = true;
  int region_[3]{}, forward_[3]{};
  float cells_per_length_ = 0;
};

}  // namespace kaustik
