#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "kaustik/transport/vertex.h"

namespace kaustik {

/// Where light paths go on from matt surfaces, as it was learned. What is worth going to are balls;
/// of the paths that arrive in a cell, a part of space on one of six sides, each ball gets a share,
/// drawn evenly from the cone around it, and the rest goes on as ever. Immutable.
class ScatterGuide {
 public:
  struct Ball {
    Vec3f center;
    float radius = 0;
  };
  /// A share of the paths of a cell.
  struct Share {
    uint32_t ball = 0;
    float of_paths = 0;
  };
  struct Cell {
    float guided = 0;             ///< all shares together, below 1
    uint32_t begin = 0, end = 0;  ///< its shares
  };
  /// Inner nodes have two children, one after the other.
  struct Node {
    int axis = -1;      ///< −1: a leaf
    float split = 0;    ///< positions below it are in the first child
    uint32_t next = 0;  ///< the first child; of a leaf its cell
  };
  struct Parts {
    std::vector<Ball> balls;
    std::vector<Node> nodes;  ///< the roots of the sides come first
    std::vector<Cell> cells;
    std::vector<Share> shares;
  };
  /// Which way a surface faces: an axis, and its sign.
  static constexpr int side_count = 6;
  /// Of a surface whose normal, where the light arrives, is `normal`.
  static int side_of(const Vec3f& normal);
  /// Density per solid angle of directions from `position` to `ball`, drawn evenly from the cone
  /// around it, or one of a thousandth of a radian; within it of all directions.
  static float pdf(const Ball& ball, const Vec3f& position, const Vec3f& direction);

  explicit ScatterGuide(Parts parts) : parts_(std::move(parts)) {}
  const Parts& parts() const { return parts_; }

  /// Whether light is guided at such a surface: where the event, and with it the class of what
  /// follows, leaves no choice, and bent normals do not make flux grow at grazing incidence.
  static bool guides(const SurfaceVertex& vertex) {
    return vertex.lobes() == Lobes::diffuse && !vertex.has_relief();
  }

  /// What was learned of a place.
  class Place {
   public:
    Place() = default;
    Place(const Parts& parts, const Cell& cell, const Vec3f& position)
        : parts_(&parts), cell_(&cell), position_(position) {}
    /// Share of the paths that are guided.
    float guided() const { return cell_ ? cell_->guided : 0.0f; }
    /// A direction of those; `u_ball` is uniform below guided().
    Vec3f sample(float u_ball, const Vec2f& u) const;
    /// Density per solid angle with which all paths go on in `direction`, where that of those that
    /// are not guided is `plain`.
    float pdf(float plain, const Vec3f& direction) const;

   private:
    std::span<const Share> shares() const {
      return {parts_->shares.data() + cell_->begin, parts_->shares.data() + cell_->end};
    }
    const Parts* parts_ = nullptr;
    const Cell* cell_ = nullptr;
    Vec3f position_{0, 0, 0};
  };
  Place place(const Vec3f& position, int side) const;
  /// Where `vertex` scatters light that arrives from `from`; without a share if it is not guided.
  Place place(const SurfaceVertex& vertex, const Vec3f& from) const;

 private:
  Parts parts_;
};

}  // namespace kaustik
