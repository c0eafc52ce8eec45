#include "kit/architecture.h"

#include "kit/random.h"

namespace kaustik::scenes {
namespace {

constexpr double board_thickness = 0.02, board_gap = 0.0006, board_chamfer = 0.0012;

/// A board with its top at z = 0 around `at`, its length along the unit vector `along`; the part
/// outside of [low, high] is cut off.
void add_board(Mesh& mesh, const Vec2d& at, const Vec2d& along, const Vec2d& size, const Vec2d& low,
               const Vec2d& high) {
  const Vec2d half(0.5 * size.x - board_gap, 0.5 * size.y - board_gap);
  const bool along_x = std::fabs(along.x) > 0.5;
  const Vec2d reach = along_x ? half : Vec2d(half.y, half.x);
  const Vec2d a(std::max(at.x - reach.x, low.x), std::max(at.y - reach.y, low.y));
  const Vec2d b(std::min(at.x + reach.x, high.x), std::min(at.y + reach.y, high.y));
  constexpr double least = 4 * board_chamfer;
  if (b.x - a.x < least || b.y - a.y < least) return;
  const auto first = uint32_t(mesh.vertices.size());
  for (const double z : {-board_thickness, -board_chamfer, 0.0}) {
    const double inset = z == 0 ? board_chamfer : 0;
    const Vec2d corners[] = {{a.x + inset, a.y + inset},
                             {b.x - inset, a.y + inset},
                             {b.x - inset, b.y - inset},
                             {a.x + inset, b.y - inset}};
    for (const Vec2d& p : corners) mesh.add({p.x, p.y, z});
  }
  for (uint32_t ring = 0; ring < 2; ++ring)
    for (uint32_t k = 0; k < 4; ++k) {
      const uint32_t p = first + 4 * ring + k, q = first + 4 * ring + (k + 1) % 4;
      mesh.quad(p, q, q + 4, p + 4);
    }
  mesh.quad(first + 8, first + 9, first + 10, first + 11);
  mesh.quad(first + 3, first + 2, first + 1, first);
}

std::vector<Mesh> all_shaded(std::vector<Mesh> meshes) {
  for (Mesh& mesh : meshes) mesh = shaded(mesh, 20);
  return meshes;
}

}  // namespace

Mesh wall_with_openings(double length, double height, double thickness,
                        const std::vector<Opening>& openings) {
  Mesh wall;
  double x = 0;
  const auto block = [&](double x0, double x1, double z0, double z1) {
    if (x1 > x0 && z1 > z0) wall.append(box({x0, 0, z0}, {x1, thickness, z1}));
  };
  for (const Opening& o : openings) {
    block(x, o.x, 0, height);
    block(o.x, o.x + o.width, 0, o.z);
    block(o.x, o.x + o.width, o.z + o.height, height);
    x = o.x + o.width;
  }
  block(x, length, 0, height);
  return wall;
}

RoomShell room_shell(const Vec3d& low, const Vec3d& high, double t) {
  const Vec3d l = low - Vec3d(t), h = high + Vec3d(t);
  return {box(l, {h.x, h.y, low.z}),  box({l.x, l.y, high.z}, h), box(l, {low.x, h.y, h.z}),
          box({high.x, l.y, l.z}, h), box(l, {h.x, low.y, h.z}),  box({l.x, high.y, l.z}, h)};
}

Mesh moulding_around(const Curve& outline, const Vec2d& low, const Vec2d& high, double z) {
  // Clockwise from above: the right of the path is inside the room.
  SweepOptions options;
  options.closed_path = true;
  return swept(outline,
               {{low.x, low.y, z}, {low.x, high.y, z}, {high.x, high.y, z}, {high.x, low.y, z}},
               {0, 0, 1}, options);
}

Curve skirting_outline(double height, double depth) {
  return {{0, 0},
          {depth, 0},
          {depth, 0.78 * height},
          {0.8 * depth, 0.86 * height},
          {0.45 * depth, 0.92 * height},
          {0.3 * depth, height},
          {0, height}};
}

Curve cornice_outline(double s) {
  Curve outline = {{0, -s}, {0.08 * s, -s}, {0.12 * s, -0.88 * s}};
  for (int i = 0; i <= 6; ++i) {  // a cove
    const double angle = 0.5 * pi_d * i / 6;
    outline.emplace_back(0.12 * s + 0.7 * s * (1 - std::cos(angle)),
                         -0.82 * s + 0.7 * s * std::sin(angle));
  }
  outline.insert(outline.end(), {{0.88 * s, -0.12 * s}, {s, -0.08 * s}, {s, 0}, {0, 0}});
  return outline;
}

Mesh window_bars(double width, double height, int columns, int rows, double bar) {
  const double h = 0.5 * bar;
  Mesh bars;
  for (int i = 0; i <= columns; ++i) {
    const double x = h + (width - bar) * i / columns;
    bars.append(box({x - h, -h, 0}, {x + h, h, height}));
  }
  for (int j = 0; j <= rows; ++j) {
    const double z = h + (height - bar) * j / rows;
    // A little thinner than the posts, so that no faces coincide.
    bars.append(box({h, -0.9 * h, z - h}, {width - h, 0.9 * h, z + h}));
  }
  return bars;
}

std::vector<Mesh> herringbone_floor(const Vec2d& low, const Vec2d& high, double board_length,
                                    double board_width, int groups, uint64_t seed) {
  std::vector<Mesh> meshes(2 * size_t(groups));
  Random random(seed);
  const double l = board_length, w = board_width;
  const Vec2d size(l, w);
  // Boards along x climb like stairs, each step (w, w); a board along y stands at the end of each,
  // its top level with it. After 2 l to the right the stairs come again.
  const Vec2d middle = (low + high) * 0.5;
  const int reach = int(std::ceil((high - low).length() / w)) + int(l / w) + 2;
  for (int i = -reach; i <= reach; ++i)
    for (int j = -reach; j <= reach; ++j) {
      const Vec2d at = middle + Vec2d(w, w) * i + Vec2d(2 * l, 0) * j;
      if (at.x < low.x - 2 * l || at.x > high.x + 2 * l || at.y < low.y - 2 * l ||
          at.y > high.y + 2 * l)
        continue;
      const auto board = [&](const Vec2d& center, const Vec2d& along) {
        const size_t first = along.x > 0.5 ? 0 : size_t(groups);
        add_board(meshes[first + random.index(size_t(groups))], center, along, size, low, high);
      };
      board(at + Vec2d(0.5 * l, 0.5 * w), {1, 0});
      board(at + Vec2d(l + 0.5 * w, w - 0.5 * l), {0, 1});
    }
  return all_shaded(std::move(meshes));
}

std::vector<Mesh> board_floor(const Vec2d& low, const Vec2d& high, double board_length,
                              double board_width, int groups, uint64_t seed) {
  std::vector<Mesh> meshes(static_cast<size_t>(groups));
  Random random(seed);
  for (double x = low.x + 0.5 * board_width; x < high.x + 0.5 * board_width; x += board_width)
    for (double y = low.y + board_length * (random.next() - 0.5); y < high.y + board_length;
         y += board_length)
      add_board(meshes[random.index(size_t(groups))], {x, y}, {0, 1}, {board_length, board_width},
                low, high);
  return all_shaded(std::move(meshes));
}

std::vector<Mesh> chequered_floor(const Vec2d& low, const Vec2d& high, double slab) {
  std::vector<Mesh> meshes(2);
  const int nx = int(std::ceil((high.x - low.x) / slab)),
            ny = int(std::ceil((high.y - low.y) / slab));
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i)
      add_board(meshes[size_t(i + j) % 2], low + Vec2d(i + 0.5, j + 0.5) * slab, {1, 0},
                {slab, slab}, low, high);
  return all_shaded(std::move(meshes));
}

}  // namespace kaustik::scenes
