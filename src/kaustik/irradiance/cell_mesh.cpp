#include "kaustik/irradiance/cell_mesh.h"

namespace kaustik {
namespace {

/// What is infinitely far away is put at so many times the largest finite distance.
constexpr float beyond = 100;
/// Edges that point closer to the surface point than this share of their distance are moved aside.
constexpr double least_offset = 1e-3;

struct EdgeHessian {
  double xx, xy, yy;
};

/// Second derivatives, by the position of the point x at the origin, of the share of the edge P → Q
/// in Lambert's formula: ½ n · (P × Q)/|P × Q| α = ½ n · ∫ r × dr / |r|², n = z. With h the
/// distance of the line, f its direction, u that of the edge and θ the angle from f, a point of it
/// is r = h (f + u tan θ); all integrals over the edge become some over powers of cosines.
EdgeHessian edge_hessian(const Vec3d& p, const Vec3d& q) {
  const Vec3d edge = q - p;
  const double size = edge.length();
  const double p_distance = p.length(), q_distance = q.length();
  if (!(size > 1e-9 * p_distance)) return {0, 0, 0};
  const Vec3d u = edge / size;
  const double p_along = p.dot(u), q_along = p_along + size;
  const Vec3d foot = p - u * p_along;
  const double foot_distance = foot.length();
  if (!(foot_distance > 0)) return {0, 0, 0};
  const Vec3d f = foot / foot_distance;
  const double h = std::max(foot_distance, least_offset * std::min(p_distance, q_distance));
  const double p_reach = std::sqrt(h * h + p_along * p_along),
               q_reach = std::sqrt(h * h + q_along * q_along);
  const double p_sin = p_along / p_reach, q_sin = q_along / q_reach;
  const double p_cos = h / p_reach, q_cos = h / q_reach;
  const double angle = std::atan2(h * size, h * h + p_along * q_along);
  // ∫ cos², ∫ cos⁴, ∫ sin cos, ∫ sin cos³ and ∫ sin² cos² over θ.
  const double c2 = 0.5 * (angle + q_sin * q_cos - p_sin * p_cos);
  const double p_cos_sq = p_cos * p_cos, q_cos_sq = q_cos * q_cos;
  const double c4 = 0.25 * (q_sin * q_cos * q_cos_sq - p_sin * p_cos * p_cos_sq + 3 * c2);
  const double sc = 0.5 * (p_cos_sq - q_cos_sq);
  const double sc3 = 0.25 * (p_cos_sq * p_cos_sq - q_cos_sq * q_cos_sq);
  const double s2c2 = c2 - c4;
  // z · (r × dr)/|r|² is m dθ; by x it changes with r × dr, as w = z × u tells, and with |r|².
  const double m = f.x * u.y - f.y * u.x;
  const double w[2] = {-u.y, u.x};
  const double a[2] = {f.x * c2 + u.x * sc, f.y * c2 + u.y * sc};
  const auto second = [&](int j, int k) {
    const double curvature =
        4 * (f[j] * f[k] * c4 + (f[j] * u[k] + f[k] * u[j]) * sc3 + u[j] * u[k] * s2c2) -
        (j == k ? c2 : 0);
    return (w[j] * a[k] + w[k] * a[j] + m * curvature) / (h * h);
  };
  return {second(0, 0), second(0, 1), second(1, 1)};
}

class CellMesh {
 public:
  CellMesh(const HemisphereGrid& grid, const std::vector<HemisphereCell>& cells)
      : grid_(grid), cells_(cells) {
    float farthest = 0;
    for (const HemisphereCell& c : cells)
      if (std::isfinite(c.distance)) farthest = std::max(farthest, c.distance);
    far_away_ = farthest > 0 ? beyond * farthest : 0;
    for (const HemisphereCell& c : cells)
      vertices_.push_back(Vec3d(c.direction) * double(distance(c)));
  }

  TangentHessian hessian() {
    if (!(far_away_ > 0) || grid_.theta_cells < 2 || grid_.phi_cells < 3) return {};
    make_triangles();
    for (int i = 0; i < grid_.theta_cells; ++i)
      for (int j = 0; j < grid_.phi_cells; ++j) {
        if (i + 1 == grid_.theta_cells) continue;
        const int left = j > 0 ? j - 1 : grid_.phi_cells - 1;
        add_edge(vertex(i, j), vertex(i, j + 1), i > 0 ? outer(i - 1, j) : zenith_, inner(i, j));
        add_edge(vertex(i, j), vertex(i + 1, j), outer(i, j), inner(i, left));
        add_edge(vertex(i, j), vertex(i + 1, j + 1), inner(i, j), outer(i, j));
      }
    return sum_;
  }

 private:
  struct Face {
    Spectrum radiance;
    bool open = true;
  };

  int vertex(int i, int j) const { return i * grid_.phi_cells + j % grid_.phi_cells; }
  /// The triangle that shares the edge toward the zenith of the quadrilateral from (i, j) to
  /// (i + 1, j + 1), and the one that shares the edge away from it.
  const Face& inner(int i, int j) const { return faces_[size_t(2 * vertex(i, j))]; }
  const Face& outer(int i, int j) const { return faces_[size_t(2 * vertex(i, j) + 1)]; }

  float distance(const HemisphereCell& cell) const {
    return std::isfinite(cell.distance) ? std::max(cell.distance, 1e-12f) : far_away_;
  }

  template <typename Vertices>
  Face face_of(const Vertices& vertices) const {
    float farthest = 0;
    for (const int v : vertices) farthest = std::max(farthest, distance(cells_[size_t(v)]));
    Face face;
    float total = 0;
    for (const int v : vertices) {
      const HemisphereCell& cell = cells_[size_t(v)];
      const float weight = sqr(sqr(distance(cell) / farthest));
      face.radiance += cell.radiance * weight;
      total += weight;
      face.open = face.open && cell.open;
    }
    face.radiance = face.radiance / total;
    return face;
  }

  void make_triangles() {
    for (int i = 0; i + 1 < grid_.theta_cells; ++i)
      for (int j = 0; j < grid_.phi_cells; ++j) {
        const int a = vertex(i, j), b = vertex(i, j + 1);
        const int c = vertex(i + 1, j + 1), d = vertex(i + 1, j);
        faces_.push_back(face_of(std::initializer_list<int>{a, b, c}));
        faces_.push_back(face_of(std::initializer_list<int>{a, c, d}));
      }
    std::vector<int> ring;
    for (int j = 0; j < grid_.phi_cells; ++j) ring.push_back(j);
    zenith_ = face_of(ring);
  }

  /// `left` of the edge from `p` to `q`, as seen from the surface point with the azimuth growing
  /// counterclockwise about z. The horizon moves along with the point: its edges don't count.
  void add_edge(int p, int q, const Face& left, const Face& right) {
    if (!left.open || !right.open) return;
    const EdgeHessian h = edge_hessian(vertices_[size_t(p)], vertices_[size_t(q)]);
    const Spectrum step = left.radiance - right.radiance;
    sum_.xx += step * float(h.xx);
    sum_.xy += step * float(h.xy);
    sum_.yy += step * float(h.yy);
  }

  const HemisphereGrid& grid_;
  const std::vector<HemisphereCell>& cells_;
  float far_away_ = 0;  ///< m; 0: nothing is near
  std::vector<Vec3d> vertices_;
  std::vector<Face> faces_;
  Face zenith_;
  TangentHessian sum_;
};

}  // namespace

TangentHessian translation_hessian(const HemisphereGrid& grid,
                                   const std::vector<HemisphereCell>& cells) {
  return CellMesh(grid, cells).hessian();
}

}  // namespace kaustik
