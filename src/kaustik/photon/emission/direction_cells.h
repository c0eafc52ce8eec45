#pragma once
#include <functional>
#include <vector>

#include "kaustik/base/vec.h"

namespace kaustik {

/// Directions in cells: a grid on each face of a cube about the axes, over the part of the face
/// that is needed. A distribution over the cells gives an exact density that costs one look-up.
class DirectionCells {
 public:
  /// Cells for all directions in which any of `boxes` is seen from the coordinates' origin, and no
  /// others but by rounding: an origin that varies within a box of its own is allowed for by
  /// widening the boxes by it (Minkowski difference). `resolution` cells along each side of a face.
  DirectionCells(const std::vector<Bounds3f>& boxes, int resolution);

  /// What a cell's chance is made of.
  struct Cell {
    Vec3f center;           ///< unit direction
    float cos_radius = 1;   ///< of the widest angle between the centre and the cell's corners
    float solid_angle = 0;  ///< sr
  };
  /// Sets the cells' chances to be in proportion to `weight(cell)`, at least 0, asked only of cells
  /// that see a box. False if all weigh nothing.
  bool set_weights(const std::function<double(const Cell&)>& weight);

  /// Unit; `u_cell` picks the cell. Not while nothing has a weight.
  Vec3f sample(float u_cell, const Vec2f& u) const;
  /// Of sample(), per solid angle.
  float pdf(const Vec3f& direction) const;
  size_t occupied() const { return occupied_.size(); }

 private:
  /// The part of a face that boxes are seen in, in face coordinates: x/w and y/w, where w is the
  /// coordinate along the face's axis.
  struct Window {
    float min[2] = {1, 1}, max[2] = {-1, -1};
    bool empty() const { return !(min[0] < max[0] && min[1] < max[1]); }
  };
  /// A box in the coordinates of a face.
  struct FaceBox {
    float min[2], max[2], near, far;
  };
  static FaceBox in_face(const Bounds3f& box, int face);
  static Vec3f direction_of(int face, float x, float y);
  void widen_window(const FaceBox& box, Window& window) const;
  void mark(const FaceBox& box, int face);
  size_t index(int face, int x, int y) const {
    return (size_t(face) * size_t(resolution_) + size_t(y)) * size_t(resolution_) + size_t(x);
  }
  float step(int face, int axis) const {
    return (windows_[face].max[axis] - windows_[face].min[axis]) / float(resolution_);
  }

  int resolution_;
  Window windows_[6];
  std::vector<uint32_t> occupied_;
  std::vector<float> cumulative_;  ///< of the occupied cells' chances
  std::vector<float> density_;     ///< of all cells: chance over area on the face; 0: sees nothing
};

}  // namespace kaustik
