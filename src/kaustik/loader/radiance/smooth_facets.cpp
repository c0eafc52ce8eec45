#include "kaustik/loader/radiance/smooth_facets.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "kaustik/loader/radiance/placement.h"
#include "kaustik/loader/radiance/surface_parts.h"

namespace kaustik::radiance {
namespace {

/// What the reals of a texture are.
enum class Smoothing {
  none,
  by_corners,      ///< three normals
  bent,            ///< surf.cal: an axis, and what is added to the normal of the facet
  linear,          ///< tmesh.cal: an axis, and the normal as a linear function
  by_barycentric,  ///< older tmesh.cal: an axis, barycentric coordinates, and three normals
};

Smoothing smoothing_of(const Modifier* modifier) {
  if (!modifier || modifier->type() != "texfunc" || modifier->strings().size() < 4)
    return Smoothing::none;
  const std::string& file = modifier->strings()[3];
  const size_t n = modifier->reals().size();
  if (file == "corner_normals" && n == 9) return Smoothing::by_corners;
  if (file.ends_with("surf.cal") && n == 13) return Smoothing::bent;
  const bool bends = modifier->strings()[0] == "dx";  // 'u' and 'v' look up something else
  if (file.ends_with("tmesh.cal") && bends && n == 10) return Smoothing::linear;
  if (file.ends_with("tmesh.cal") && bends && n == 16) return Smoothing::by_barycentric;
  return Smoothing::none;
}

Vec3d row_of(const std::vector<double>& reals, size_t first) {
  return {reals[first], reals[first + 1], reals[first + 2]};
}

/// `u` and `v` are the coordinates behind the axis in the first number, `normal` that of the facet.
Vec3d normal_by(Smoothing smoothing, const std::vector<double>& reals, double u, double v,
                const Vec3d& normal) {
  const auto affine = [&](size_t first) {
    return u * reals[first] + v * reals[first + 1] + reals[first + 2];
  };
  if (smoothing == Smoothing::bent)
    return normal + row_of(reals, 1) * (u * v) + row_of(reals, 4) * u + row_of(reals, 7) * v +
           row_of(reals, 10);
  if (smoothing == Smoothing::linear) return {affine(1), affine(4), affine(7)};
  const double a = affine(1), b = affine(4);
  const Vec3d shares(a, b, 1 - a - b);
  return {shares.dot(row_of(reals, 7)), shares.dot(row_of(reals, 10)),
          shares.dot(row_of(reals, 13))};
}

}  // namespace

bool is_smoothing(const Modifier* modifier) { return smoothing_of(modifier) != Smoothing::none; }

std::optional<std::vector<Vec3d>> corner_normals_of(const Modifier* modifier,
                                                    const Primitive& polygon,
                                                    const Transform& placed) {
  const Smoothing smoothing = smoothing_of(modifier);
  if (smoothing == Smoothing::none) return std::nullopt;
  const std::vector<double>& reals = modifier->reals();
  std::vector<Vec3d> normals;
  if (smoothing == Smoothing::by_corners) {
    if (polygon.reals.size() != 9) return std::nullopt;
    for (size_t i = 0; i < 9; i += 3) normals.push_back(placed_vector(placed, row_of(reals, i)));
    return normals;
  }
  const auto own = transform_in(std::span(modifier->strings()).subspan(4));
  if (!own) return std::nullopt;
  const Transform own_from_file = own->inverse();
  std::vector<Vec3d> corners;
  for (size_t i = 0; i + 2 < polygon.reals.size(); i += 3)
    corners.push_back(placed_point(own_from_file, vector_at(polygon, i)));
  const Vec3d normal = area_vector_of(corners).normalized() * (is_mirrored(*own) ? -1.0 : 1.0);
  const int axis = int(std::clamp(reals[0], 0.0, 2.0));
  for (const Vec3d& corner : corners)
    normals.push_back(placed_vector(
        placed * *own,
        normal_by(smoothing, reals, corner[(axis + 1) % 3], corner[(axis + 2) % 3], normal)));
  return normals;
}

}  // namespace kaustik::radiance
