#pragma once
#include <array>
#include <span>
#include <vector>

#include "kaustik/base/memory.h"
#include "kaustik/base/vec.h"

namespace kaustik {

/// Cuts the polygons of one mesh file into triangles, convex or not, coplanar or not.
class PolygonCutter {
 public:
  using Triangle = std::array<uint32_t, 3>;
  using Triangles = UnsetVector<Triangle>;

  /// All polygons together may take steps in proportion to the size of their file, so that no file
  /// takes long for its size.
  explicit PolygonCutter(size_t bytes_of_file) : steps_(40 * bytes_of_file + 100'000) {}

  /// Appends corners.size() − 2 triangles whose sides are sides or diagonals of the polygon, wound
  /// as it is. Where it is convex they are the fan from its first corner. Parts that only touch
  /// (holes reached by a slit, lobes that meet in a point) are told apart; where sides cross, some
  /// triangles overlap. Corners are indices into `positions`, at least three; triangles have the
  /// names of corners in their stead. False if the steps are spent; then triangles are missing.
  [[nodiscard]] bool cut(std::span<const Vec3f> positions, std::span<const uint32_t> corners,
                         std::span<const uint32_t> names, Triangles& triangles);

 private:
  size_t steps_;
};

}  // namespace kaustik
