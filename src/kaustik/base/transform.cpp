#include "kaustik/base/transform.h"

#include <Imath/ImathMatrixAlgo.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace kaustik {
namespace {

Imath::M44d imath_from_rows(const std::array<std::array<double, 4>, 4>& rows) {
  Imath::M44d m;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) m[i][j] = rows[i][j];
  return m;
}

}  // namespace

Transform::Transform(const double (&rows)[4][4]) {
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      if (!std::isfinite(rows[i][j])) throw std::invalid_argument("matrix is not finite");
      matrix_[i][j] = rows[i][j];
    }
  Imath::M44d inverse;
  try {
    inverse = imath_from_rows(matrix_).gjInverse(true);
  } catch (const std::exception&) {
    throw std::invalid_argument("matrix is singular");
  }
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) inverse_[i][j] = inverse[i][j];
}

Transform::Transform(const double (&rows)[4][4], const double (&inverse)[4][4]) {
  // Rounding of products may leave so much where the numbers of both are large.
  constexpr double tolerance = 1e-6;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      if (!std::isfinite(rows[i][j]) || !std::isfinite(inverse[i][j]))
        throw std::invalid_argument("matrix is not finite");
      matrix_[i][j] = rows[i][j];
      inverse_[i][j] = inverse[i][j];
    }
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      double product = 0, size = 1;
      for (int k = 0; k < 4; ++k) {
        product += rows[i][k] * inverse[k][j];
        size += std::abs(rows[i][k] * inverse[k][j]);
      }
      if (!(std::abs(product - (i == j ? 1 : 0)) <= tolerance * size))
        throw std::invalid_argument("matrix and inverse do not belong together");
    }
}

Transform Transform::collapsing(const double (&rows)[4][4]) {
  Rows matrix;
  for (size_t i = 0; i < 4; ++i) std::copy(rows[i], rows[i] + 4, matrix[i].begin());
  return collapsed(matrix, 3);
}

Transform Transform::collapsed(const Rows& rows, int most_dimensions) {
  if (rows[3] != identity_rows[3]) throw std::invalid_argument("matrix is singular");
  Imath::M33d linear;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j) {
      const double entry = rows[size_t(i)][size_t(j)];
      if (!std::isfinite(entry)) throw std::invalid_argument("matrix is not finite");
      if (j < 3) linear[i][j] = entry;
    }
  Imath::M33d u, v;
  Imath::V3d factors;
  Imath::jacobiSVD(linear, u, factors, v, std::numeric_limits<double>::epsilon(), true);
  // Products of rotations and factors of zero are singular but for rounding.
  constexpr double nothing = 1e-13;
  Transform result;
  result.matrix_ = rows;
  result.dimensions_ = 0;
  for (int i = 0; i < most_dimensions; ++i)
    if (std::fabs(factors[i]) > nothing * std::fabs(factors[0])) ++result.dimensions_;
  if (result.dimensions_ == 3) {
    double matrix[4][4];
    for (size_t i = 0; i < 4; ++i) std::copy(rows[i].begin(), rows[i].end(), matrix[i]);
    return Transform(matrix);
  }
  result.inverse_ = {};
  if (result.dimensions_ < 2) return result;
  // As if a little were left of what is flattened, on the side that keeps frames right-handed.
  constexpr double left = 1e-6;
  factors.z = left * factors.y;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k)
        result.inverse_[size_t(i)][size_t(j)] += v[i][k] * u[j][k] / factors[k];
  return result;
}

Transform Transform::translate(const Vec3d& t) {
  const double m[4][4] = {{1, 0, 0, t.x}, {0, 1, 0, t.y}, {0, 0, 1, t.z}, {0, 0, 0, 1}};
  return Transform(m);
}

Transform Transform::scale(const Vec3d& s) {
  const double m[4][4] = {{s.x, 0, 0, 0}, {0, s.y, 0, 0}, {0, 0, s.z, 0}, {0, 0, 0, 1}};
  return Transform(m);
}

Transform Transform::rotate(const Vec3d& axis, double degrees) {
  const double length = axis.length();
  if (!(length > 0)) throw std::invalid_argument("rotation axis is zero");
  const Vec3d a = axis / length;
  const double angle = degrees * std::numbers::pi / 180.0;
  const double s = std::sin(angle), c = std::cos(angle), t = 1 - c;
  const double m[4][4] = {{t * a.x * a.x + c, t * a.x * a.y - s * a.z, t * a.x * a.z + s * a.y, 0},
                          {t * a.x * a.y + s * a.z, t * a.y * a.y + c, t * a.y * a.z - s * a.x, 0},
                          {t * a.x * a.z - s * a.y, t * a.y * a.z + s * a.x, t * a.z * a.z + c, 0},
                          {0, 0, 0, 1}};
  return Transform(m);
}

Transform Transform::look_at(const Vec3d& origin, const Vec3d& target, const Vec3d& up) {
  const Vec3d forward = target - origin;
  if (!(forward.length() > 0)) throw std::invalid_argument("look-at origin and target are equal");
  const Vec3d z = forward.normalized();
  const Vec3d left = up.cross(z);
  if (!(left.length() > 1e-12 * up.length()))
    throw std::invalid_argument("look-at up vector is zero or parallel to the view direction");
  const Vec3d x = left.normalized();
  const Vec3d y = z.cross(x);
  const double m[4][4] = {{x.x, y.x, z.x, origin.x},
                          {x.y, y.y, z.y, origin.y},
                          {x.z, y.z, z.z, origin.z},
                          {0, 0, 0, 1}};
  return Transform(m);
}

Transform operator*(const Transform& a, const Transform& b) {
  Transform c;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      c.matrix_[i][j] = 0;
      c.inverse_[i][j] = 0;
      for (int k = 0; k < 4; ++k) {
        c.matrix_[i][j] += a.matrix_[i][k] * b.matrix_[k][j];
        c.inverse_[i][j] += b.inverse_[i][k] * a.inverse_[k][j];
      }
    }
  const int most = std::min(a.dimensions_, b.dimensions_);
  if (most == 3) return c;
  return Transform::collapsed(c.matrix_, most);
}

Vec3f Transform::point(const Vec3f& p) const {
  const auto& m = matrix_;
  const double w = m[3][0] * p.x + m[3][1] * p.y + m[3][2] * p.z + m[3][3];
  const double inv_w = 1.0 / w;
  return {float((m[0][0] * p.x + m[0][1] * p.y + m[0][2] * p.z + m[0][3]) * inv_w),
          float((m[1][0] * p.x + m[1][1] * p.y + m[1][2] * p.z + m[1][3]) * inv_w),
          float((m[2][0] * p.x + m[2][1] * p.y + m[2][2] * p.z + m[2][3]) * inv_w)};
}

Vec3f Transform::vector(const Vec3f& v) const {
  const auto& m = matrix_;
  return {float(m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z),
          float(m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z),
          float(m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z)};
}

Vec3f Transform::normal(const Vec3f& n) const {
  const auto& m = inverse_;
  return {float(m[0][0] * n.x + m[1][0] * n.y + m[2][0] * n.z),
          float(m[0][1] * n.x + m[1][1] * n.y + m[2][1] * n.z),
          float(m[0][2] * n.x + m[1][2] * n.y + m[2][2] * n.z)};
}

Transform Transform::inverse() const {
  Transform t;
  t.matrix_ = inverse_;
  t.inverse_ = matrix_;
  return t;
}

Bounds3f Transform::bounds(const Bounds3f& b) const {
  Bounds3f result;
  if (b.isEmpty()) return result;
  for (int i = 0; i < 8; ++i)
    result.extendBy(
        point({i & 1 ? b.max.x : b.min.x, i & 2 ? b.max.y : b.min.y, i & 4 ? b.max.z : b.min.z}));
  return result;
}

double Transform::determinant3() const {
  if (dimensions_ < 3) return 0;
  const auto& m = matrix_;
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

}  // namespace kaustik
