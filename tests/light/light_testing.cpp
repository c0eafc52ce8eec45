#include "tests/light/light_testing.h"

#include <stdexcept>

#include "kaustik/base/warp.h"
#include "kaustik/image/image_io.h"
#include "tests/support/temporary_folder.h"

namespace kaustik::testing {

Bounds3f test_bounds() { return {{-1, 0, 1}, {3, 4, 5}}; }

std::unique_ptr<Light> make_light(const std::string& type, const std::vector<Property>& properties,
                                  std::shared_ptr<const Shape> shape, const Bounds3f& scene_bounds,
                                  std::shared_ptr<const EmissionPattern> pattern) {
  for (const LightType& candidate : light_types()) {
    if (candidate.info.name != type) continue;
    Problems problems;
    const Arguments arguments(candidate.info, properties, {}, problems);
    problems.throw_if_any();
    return candidate.create(
        {arguments, Transform(), std::move(shape), 7, scene_bounds, std::move(pattern)});
  }
  throw std::logic_error("no such light");
}

namespace {

class FieldsPattern final : public EmissionPattern {
 public:
  Spectrum radiance(const SurfacePoint& at, const Wavelengths&) const override {
    constexpr float values[2][2] = {{0, 2}, {1, 0.2f}};
    return spectrum_from_rgb(1, 2, 3) * values[at.uv.x > 0.5f][at.uv.y > 0.75f];
  }
  float maximum() const override { return 6; }
};

}  // namespace

std::shared_ptr<const EmissionPattern> fields_pattern() {
  return std::make_shared<FieldsPattern>();
}

std::unique_ptr<Light> make_envmap(int width, int height, const std::vector<Rgb>& pixels,
                                   std::vector<Property> properties) {
  Image image(width, height, {"R", "G", "B"});
  for (size_t i = 0; i < pixels.size(); ++i) {
    image.channel(0)[i] = float(pixels[i].r);
    image.channel(1)[i] = float(pixels[i].g);
    image.channel(2)[i] = float(pixels[i].b);
  }
  const test::TemporaryFolder folder;
  const std::string path = folder.path("environment.exr");
  WriteOptions options;
  options.exr_half = false;
  write_image(image, path, options);
  properties.push_back({"filename", Value(path), {}});
  return make_light("envmap", properties);
}

std::vector<Rgb> spotted_pixels(int count) {
  Random random(3);
  std::vector<Rgb> pixels;
  for (int i = 0; i < count; ++i) {
    const double value = i % 7 == 3 ? 20 * random.next() : i % 5 == 0 ? 0 : random.next();
    pixels.push_back({value, 0.5 * value + 0.1 * random.next(), 0.3 * value});
  }
  return pixels;
}

std::shared_ptr<const Shape> make_shape(const std::string& type,
                                        const std::vector<Property>& properties) {
  for (const ShapeType& candidate : shape_types()) {
    if (candidate.info.name != type) continue;
    Problems problems;
    const Arguments arguments(candidate.info, properties, {}, problems);
    problems.throw_if_any();
    return candidate.create(arguments);
  }
  throw std::logic_error("no such shape");
}

namespace {

/// The map that takes the axes to x, y, z and the origin to `origin`.
Value map_to(const Vec3f& x, const Vec3f& y, const Vec3f& z, const Vec3f& origin) {
  double rows[4][4] = {};
  for (int i = 0; i < 3; ++i) {
    rows[i][0] = x[i];
    rows[i][1] = y[i];
    rows[i][2] = z[i];
    rows[i][3] = origin[i];
  }
  rows[3][3] = 1;
  return Transform(rows);
}

}  // namespace

std::shared_ptr<const Shape> make_quad(const Vec3f& corner, const Vec3f& a, const Vec3f& b) {
  const Vec3f x = a * 0.5f, y = b * 0.5f;
  return make_shape("rectangle",
                    {{"to_world", map_to(x, y, normalize(cross(a, b)), corner + x + y), {}}});
}

std::shared_ptr<const Shape> make_disk(const Vec3f& center, const Vec3f& normal, float radius) {
  const Frame f(normal);
  return make_shape("disk", {{"to_world", map_to(f.x * radius, f.y * radius, f.z, center), {}}});
}

std::shared_ptr<const Shape> make_ball(const Vec3f& center, float radius) {
  return make_shape("sphere",
                    {{"center", Value(Vec3d(center)), {}}, {"radius", Value(double(radius)), {}}});
}

namespace {

/// A direction as the coordinates of DirectionGrid in [0, 1)²; anything outside if it misses.
Vec2f grid_coordinates(const DirectionGrid& grid, const Vec3f& direction) {
  const Vec3f local = Frame(grid.axis).to_local(direction);
  const float height =
      local.z > 0 ? (sqr(local.x) + sqr(local.y)) / (1.0f + local.z) : 1.0f - local.z;
  const float turn = std::atan2(local.y, local.x) / (2.0f * pi);
  return {height / grid.one_minus_cos, turn < 0 ? turn + 1.0f : turn};
}

}  // namespace

double direction_p_value(const DirectionGrid& grid, int count, const std::function<Vec3f()>& sample,
                         const std::function<double(const Vec3f&)>& pdf_solid_angle) {
  const size_t cells = size_t(grid.rings * grid.sectors);
  std::vector<double> observed(cells + 1, 0.0), expected(cells + 1, 0.0);
  for (int i = 0; i < count; ++i) {
    const Vec3f direction = sample();
    size_t cell = cells;
    if (length_sq(direction) > 0) {
      const Vec2f p = grid_coordinates(grid, direction);
      const int ring = int(p.x * float(grid.rings));
      const int sector = std::min(int(p.y * float(grid.sectors)), grid.sectors - 1);
      if (ring < grid.rings) cell = size_t(ring * grid.sectors + sector);
    }
    observed[cell] += 1;
  }
  const double cell_angle = 2.0 * double(pi) * grid.one_minus_cos / double(cells);
  const double weight = cell_angle / sqr(float(grid.fine)) * count;
  const Frame frame(grid.axis);
  double inside = 0;
  for (int y = 0; y < grid.rings * grid.fine; ++y)
    for (int x = 0; x < grid.sectors * grid.fine; ++x) {
      const Vec2f u((float(y) + 0.5f) / float(grid.rings * grid.fine),
                    (float(x) + 0.5f) / float(grid.sectors * grid.fine));
      const Vec3f direction = frame.to_world(square_to_cone(u, grid.one_minus_cos));
      const double value = weight * pdf_solid_angle(direction);
      expected[size_t(y / grid.fine * grid.sectors + x / grid.fine)] += value;
      inside += value;
    }
  expected[cells] = std::max(0.0, count - inside);
  // Nothing misses but by rounding, here and in the integral.
  if (std::max(observed[cells], expected[cells]) < 1e-3 * count) {
    observed.pop_back();
    expected.pop_back();
  }
  return chi_square_p_value(observed, expected);
}

std::function<double(const Vec3f&)> with_planted_error(
    const DirectionGrid& grid, std::function<double(const Vec3f&)> pdf_solid_angle) {
  return [grid, pdf = std::move(pdf_solid_angle)](const Vec3f& direction) {
    return pdf(direction) * (grid_coordinates(grid, direction).y < 0.5f ? 1.02 : 0.98);
  };
}

double square_p_value(int count, bool planted_error, const std::function<Vec2f()>& sample) {
  constexpr int side = 10;
  std::vector<double> observed(side * side, 0.0), expected(side * side, 0.0);
  for (int i = 0; i < count; ++i) {
    const Vec2f p = sample();
    const int x = std::clamp(int(p.x * side), 0, side - 1);
    const int y = std::clamp(int(p.y * side), 0, side - 1);
    observed[size_t(y * side + x)] += 1;
  }
  for (int i = 0; i < side * side; ++i) {
    const double error = !planted_error ? 1.0 : i % side < side / 2 ? 0.98 : 1.02;
    expected[size_t(i)] = error * count / (side * side);
  }
  return chi_square_p_value(observed, expected);
}

}  // namespace kaustik::testing
