#include "kit/surface.h"

namespace kaustik::scenes {
namespace {

/// A grid of vertices; `flip` faces it the other way.
void add_grid(Mesh& mesh, int nu, int nv, const std::vector<Vec3d>& points, bool flip) {
  const auto first = uint32_t(mesh.vertices.size());
  const auto row = uint32_t(nu + 1);
  for (int j = 0; j <= nv; ++j)
    for (int i = 0; i <= nu; ++i)
      mesh.add(points[size_t(j) * row + size_t(i)], {double(i) / nu, double(j) / nv});
  for (uint32_t j = 0; j < uint32_t(nv); ++j)
    for (uint32_t i = 0; i < uint32_t(nu); ++i) {
      const uint32_t a = first + j * row + i, b = a + 1, c = a + row + 1, d = a + row;
      if (flip)
        mesh.quad(a, d, c, b);
      else
        mesh.quad(a, b, c, d);
    }
}

/// Quads between the borders of two grids with the same counts: `upper` faces out, `lower` in.
void add_rim(Mesh& mesh, int nu, int nv, uint32_t upper, uint32_t lower) {
  const auto row = uint32_t(nu + 1);
  std::vector<uint32_t> border;  // counterclockwise seen from the upper side
  for (int i = 0; i < nu; ++i) border.push_back(uint32_t(i));
  for (int j = 0; j < nv; ++j) border.push_back(uint32_t(j) * row + uint32_t(nu));
  for (int i = nu; i > 0; --i) border.push_back(uint32_t(nv) * row + uint32_t(i));
  for (int j = nv; j > 0; --j) border.push_back(uint32_t(j) * row);
  for (size_t k = 0; k < border.size(); ++k) {
    const uint32_t a = border[k], b = border[(k + 1) % border.size()];
    mesh.quad(lower + a, lower + b, upper + b, upper + a);
  }
}

}  // namespace

Mesh sheet(int nu, int nv, const SurfaceFunction& surface) {
  std::vector<Vec3d> points;
  for (int j = 0; j <= nv; ++j)
    for (int i = 0; i <= nu; ++i) points.push_back(surface(double(i) / nu, double(j) / nv));
  Mesh mesh;
  add_grid(mesh, nu, nv, points, false);
  return shaded(mesh, 180);
}

Mesh thick_sheet(int nu, int nv, double thickness, const SurfaceFunction& surface,
                 double crease_degrees) {
  constexpr double step = 1e-4;  // of the parameters, for the normal
  std::vector<Vec3d> upper, lower;
  for (int j = 0; j <= nv; ++j)
    for (int i = 0; i <= nu; ++i) {
      const double u = double(i) / nu, v = double(j) / nv;
      const Vec3d du = surface(u + step, v) - surface(u - step, v);
      const Vec3d dv = surface(u, v + step) - surface(u, v - step);
      upper.push_back(surface(u, v));
      lower.push_back(upper.back() - du.cross(dv).normalized() * thickness);
    }
  Mesh mesh;
  add_grid(mesh, nu, nv, upper, false);
  add_grid(mesh, nu, nv, lower, true);
  add_rim(mesh, nu, nv, 0, uint32_t(upper.size()));
  return shaded(mesh, crease_degrees);
}

Mesh height_field(const Vec2d& low, const Vec2d& high, int nx, int ny, double base,
                  const std::function<double(double x, double y)>& height) {
  std::vector<Vec3d> top, bottom;
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) {
      const double x = low.x + (high.x - low.x) * i / nx, y = low.y + (high.y - low.y) * j / ny;
      top.emplace_back(x, y, height(x, y));
      bottom.emplace_back(x, y, base);
    }
  Mesh mesh;
  add_grid(mesh, nx, ny, top, false);
  add_grid(mesh, nx, ny, bottom, true);
  add_rim(mesh, nx, ny, 0, uint32_t(top.size()));
  return shaded(mesh, 40);
}

Mesh leaf(double length, double width, double fold, double droop) {
  const auto blade = [=](double u, double v) {
    const double along = u * length;
    const double angle = droop * u;  // the blade bends like a bow: a circle arc
    const double bow = droop != 0 ? length / droop : 0;
    const double x = droop != 0 ? bow * std::sin(angle) : along;
    const double z = droop != 0 ? -bow * (1 - std::cos(angle)) : 0;
    const double half =
        0.5 * width *
        (0.06 + std::pow(std::sin(pi_d * std::pow(std::clamp(u, 0.0, 1.0), 0.8)), 0.9));
    const double across = 2 * v - 1;
    return Vec3d(x, across * half, z + fold * half * std::fabs(across));
  };
  return thick_sheet(8, 4, 0.0006, blade, 60);
}

Mesh curtain(double width, double height, int folds, double depth) {
  const auto cloth = [=](double u, double v) {
    const double down = 1 - v;
    const double phase = 2 * pi_d * folds * (u + 0.012 * down * std::sin(3 * pi_d * u));
    return Vec3d(width * (u - 0.5), depth * (0.35 + 0.65 * down) * std::sin(phase), -height * down);
  };
  return thick_sheet(folds * 10, 8, 0.001, cloth, 60);
}

}  // namespace kaustik::scenes
