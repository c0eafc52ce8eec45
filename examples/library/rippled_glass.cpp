// Renders what a pane of rippled glass, which the program makes itself, does to the light of the
// sun, prints how bright it is at some points, and writes a picture. docs/embedding.md shows it.
// Usage: rippled_glass PICTURE [WIDTH [PASSES]]

#include <kaustik/kaustik.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <utility>
#include <vector>

namespace {

using kaustik::Vec3;

constexpr double height = 2.6, half_width = 2.5;  // of the pane, m

/// How thick the pane is at a point, m.
double thickness(double x, double y) {
  return 0.15 + 0.022 * std::sin(4.3 * x + 2.1 * y) + 0.02 * std::sin(4.9 * y - 2.6 * x + 1) +
         0.011 * std::sin(7.7 * x - 3.1 * y + 2);
}
/// Normal of the upper side, of any length.
Vec3 slope(double x, double y) {
  constexpr double step = 1e-4;
  return {(thickness(x - step, y) - thickness(x + step, y)) / (2 * step),
          (thickness(x, y - step) - thickness(x, y + step)) / (2 * step), 1};
}

/// Buffers of a mesh that grows by grids of vertices.
struct Grids {
  std::vector<float> positions, normals;
  std::vector<uint32_t> faces;

  /// `at(u, v)` and `up(u, v)` give position and normal; both arguments go from 0 to 1.
  template <typename At, typename Up>
  void add(uint32_t rows, uint32_t columns, const At& at, const Up& up) {
    const auto first = uint32_t(positions.size() / 3);
    for (uint32_t row = 0; row < rows; ++row)
      for (uint32_t column = 0; column < columns; ++column) {
        const double u = double(column) / (columns - 1), v = double(row) / (rows - 1);
        const Vec3 p = at(u, v), n = up(u, v);
        positions.insert(positions.end(), {float(p.x), float(p.y), float(p.z)});
        normals.insert(normals.end(), {float(n.x), float(n.y), float(n.z)});
        if (row + 1 == rows || column + 1 == columns) continue;
        const uint32_t a = first + row * columns + column, b = a + columns;
        faces.insert(faces.end(), {a, a + 1, b + 1, a, b + 1, b});
      }
  }
};

/// A closed body of glass, rippled above and flat below.
kaustik::Mesh pane() {
  constexpr uint32_t side = 257;
  const auto across = [](double u) { return half_width * (2 * u - 1); };
  Grids grids;
  grids.add(
      side, side,
      [&](double u, double v) {
        return Vec3{across(u), across(v), height + thickness(across(u), across(v))};
      },
      [&](double u, double v) { return slope(across(u), across(v)); });
  // From right to left, so that its faces look down.
  grids.add(
      side, side,
      [&](double u, double v) {
        return Vec3{across(1 - u), across(v), height};
      },
      [](double, double) {
        return Vec3{0, 0, -1};
      });
  // Four walls.
  for (const auto& [x, y] : {std::pair{0.0, -1.0}, {1.0, 0.0}, {0.0, 1.0}, {-1.0, 0.0}}) {
    const Vec3 out = {x, y, 0};
    grids.add(
        2, side,
        [&](double u, double v) {
          const Vec3 p = {half_width * out.x - across(u) * out.y,
                          half_width * out.y + across(u) * out.x, height};
          return Vec3{p.x, p.y, p.z + (v > 0 ? thickness(p.x, p.y) : 0)};
        },
        [&](double, double) { return out; });
  }
  kaustik::MeshBuffers buffers;
  buffers.positions = {grids.positions.data(), grids.positions.size() / 3};
  buffers.normals = {grids.normals.data(), grids.normals.size() / 3};
  buffers.faces = {grids.faces.data(), grids.faces.size() / 3};
  return kaustik::Mesh(buffers);
}

kaustik::Object ball(const Vec3& center, double radius, const kaustik::Rgb& color) {
  return kaustik::Object("shape", "sphere")
      .set("center", center)
      .set("radius", radius)
      .add(kaustik::Object("bsdf", "diffuse").set("reflectance", color));
}

/// Three balls on a table; the pane is above what the camera sees.
kaustik::Scene scene_of(int width) {
  using kaustik::Object, kaustik::Transform, kaustik::Rgb;
  const auto view = Transform::look_at({-0.5, -4.4, 2.1}, {0.05, 0, 0.4}, {0, 0, 1});
  const auto film = Object("film", "hdrfilm").set("width", width).set("height", width * 5 / 8);
  const auto table = Object("bsdf", "diffuse").set("reflectance", Rgb{0.62, 0.6, 0.56});
  return kaustik::Scene(
      {Object("sensor", "perspective").set("fov", 40).set("to_world", view).add(film),
       Object("emitter", "directional", "sun")
           .set("direction", Vec3{0.25, 0.2, -1})
           .set("irradiance", Rgb{4, 3.7, 3.1}),
       Object("emitter", "constant", "sky").set("radiance", Rgb{0.06, 0.09, 0.14}),
       Object("shape", "rectangle", "table")
           .set("to_world", Transform::scale({20, 20, 1}))
           .add(table),
       ball({-0.65, 0.1, 0.5}, 0.5, {0.75, 0.2, 0.1}), ball({0.5, 0.5, 0.6}, 0.6, {0.8, 0.8, 0.78}),
       ball({0.35, -0.75, 0.3}, 0.3, {0.1, 0.35, 0.6}),
       pane().shape("pane").add(Object("bsdf", "dielectric").set("int_ior", 1.5))});
}

/// What arrives on the table, in a bright line and between two.
void print_irradiance(const kaustik::Scene& scene) {
  const std::vector<Vec3> points = {{-0.3, -1, 0}, {0.8, -0.8, 0}, {-1.2, -0.5, 0}},
                          up = {{0, 0, 1}};
  const kaustik::Estimates measured = kaustik::irradiance(scene, points, up);
  for (size_t i = 0; i < points.size(); ++i)
    std::printf("irradiance at (%g, %g): %.2f ± %.2f W/m²\n", points[i].x, points[i].y,
                measured.luminance[i].value, measured.luminance[i].standard_error);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc < 2) {
      std::fprintf(stderr, "usage: rippled_glass PICTURE [WIDTH [PASSES]]\n");
      return 2;
    }
    const kaustik::Scene scene = scene_of(argc > 2 ? std::atoi(argv[2]) : 640);
    kaustik::SessionSettings settings;
    settings.integrator = "auto";
    settings.passes = argc > 3 ? uint32_t(std::atoi(argv[3])) : 32;
    kaustik::Callbacks callbacks;
    callbacks.pass_done = [](uint32_t passes) { std::fprintf(stderr, "\r%u passes", passes); };
    kaustik::Session session(scene, settings, callbacks);
    const kaustik::Outcome outcome = session.run();
    std::fprintf(stderr, " in %.0f s\n", outcome.seconds);
    session.picture().write(argv[1], {.jpeg_quality = 85});
    print_irradiance(scene);
    return 0;
  } catch (const kaustik::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return error.kind() == kaustik::ErrorKind::input ? 2 : 1;
  }
}
