// Samples of every shape against their densities.

#include "geometry_support.h"
#include "kaustik/base/statistics.h"

namespace kaustik::test {
namespace {

constexpr int samples = 200000 / samples_divisor;

struct SamplingCase {
  const char* name;
  std::shared_ptr<const Shape> shape;
};

std::vector<SamplingCase> sampling_cases() {
  const Transform uneven = placement() * Transform::scale({2.0, 0.5, 1.0});
  const auto mesh = make_shape("sphere", {{"to_world", uneven * Transform::scale({0.5, 2, 1}), {}}})
                        ->tessellate(2);
  return {
      {"rectangle", make_shape("rectangle", {{"to_world", uneven, {}}})},
      {"cube", make_shape("cube", {{"to_world", uneven, {}}})},
      {"disk", make_shape("disk", {{"to_world", uneven, {}}})},
      {"sphere", make_shape("sphere", {{"to_world", placement(), {}}})},
      {"ellipsoid", make_shape("sphere", {{"to_world", uneven, {}}})},
      {"pancake",
       make_shape("sphere", {{"to_world", placement() * Transform::scale({1, 1.3, 0.05}), {}}})},
      {"cylinder", make_shape("cylinder", {{"to_world", placement(), {}}})},
      {"leaning cylinder",
       make_shape("cylinder", {{"p1", Vec3d(1, 0.5, 1), {}}, {"to_world", uneven, {}}})},
      {"mesh", std::make_shared<MeshShape>(mesh)}};
}

/// Chi-square of points in the cells of a grid over the shape's bounds; what to expect comes from
/// the finely tessellated surface. `tilt` plants an error: points are drawn denser to one side.
double uniformity(const Shape& shape, float tilt) {
  constexpr int n = 5;
  const Bounds3f box = shape.bounds();
  const auto cell = [&](const Vec3f& p) {
    size_t index = 0;
    for (int i = 0; i < 3; ++i) {
      const float extent = box.max[i] - box.min[i];
      const float s = extent > 0 ? (p[i] - box.min[i]) / extent : 0;
      index = index * n + size_t(std::clamp(int(s * n), 0, n - 1));
    }
    return index;
  };
  std::vector<double> expected(n * n * n), observed(n * n * n);
  const TriangleMesh mesh = shape.tessellate(6);
  Random random(21);
  double total = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3f p0 = mesh.positions[t[0]], e1 = mesh.positions[t[1]] - p0,
                e2 = mesh.positions[t[2]] - p0;
    const double area = 0.5 * double(length(cross(e1, e2)));
    total += area;
    const int parts =
        std::clamp(int(5e6 / samples_divisor / double(mesh.triangles.size())), 20, 400000);
    const int side = std::max(2, int(std::sqrt(parts)));
    for (int i = 0; i < side; ++i)
      for (int j = 0; j < side; ++j) {
        const Vec2f b = square_to_triangle({(float(i) + random.uniform()) / float(side),
                                            (float(j) + random.uniform()) / float(side)});
        expected[cell(p0 + e1 * b.x + e2 * b.y)] += area / (side * side);
      }
  }
  for (double& e : expected) e *= samples / total;
  for (int i = 0; i < samples; ++i) {
    Vec2f u = random.square();
    u.x = std::pow(u.x, 1 + tilt);
    u.y = std::pow(u.y, 1 + tilt);
    observed[cell(shape.sample_area(u).point.position)] += 1;
  }
  // Cells that the surface only grazes would measure the tessellation.
  for (size_t i = 0; i < expected.size(); ++i)
    if (expected[i] < 20) {
      expected[0] += expected[i];
      observed[0] += observed[i];
      if (i != 0) expected[i] = observed[i] = 0;
    }
  return chi_square_p_value(observed, expected);
}

/// The numbers that a point was drawn by; those that the shape tells draw it again.
TEST(ShapeSampling, TellsTheNumbersOfItsPoints) {
  for (const SamplingCase& c : sampling_cases()) {
    SCOPED_TRACE(c.name);
    Random random(5);
    for (int i = 0; i < 2000; ++i) {
      const Vec2f u = random.square();
      const SurfacePoint point = c.shape->sample_area(u).point;
      const auto found = c.shape->area_coordinates(point);
      // Drawn by further numbers, or not known.
      if (std::string(c.name).find("cylinder") != std::string::npos ||
          std::string(c.name) == "ellipsoid" || std::string(c.name) == "pancake") {
        EXPECT_FALSE(found);
        break;
      }
      ASSERT_TRUE(found);
      ASSERT_TRUE(found->x >= 0 && found->x <= 1 && found->y >= 0 && found->y <= 1);
      const Vec2f inside(std::min(found->x, one_minus_epsilon),
                         std::min(found->y, one_minus_epsilon));
      const float size = length(c.shape->bounds().max - c.shape->bounds().min);
      ASSERT_LT(length(c.shape->sample_area(inside).point.position - point.position), 2e-3f * size);
      // A mesh of many triangles has them all within a small part of its square.
      if (c.shape->mesh() && c.shape->mesh()->triangles.size() > 12) continue;
      ASSERT_NEAR(found->x, u.x, 2e-4);
    }
  }
}

TEST(ShapeSampling, UniformByArea) {
  for (const SamplingCase& c : sampling_cases()) EXPECT_GT(uniformity(*c.shape, 0), 1e-4) << c.name;
}

TEST(ShapeSampling, TiltedSamplesFail) {
  for (const SamplingCase& c : sampling_cases())
    EXPECT_LT(uniformity(*c.shape, 0.1f), 1e-4) << c.name;
}

TEST(ShapeSampling, SamplesAreConsistentSurfacePoints) {
  Random random(22);
  for (const SamplingCase& c : sampling_cases()) {
    const auto tracer = tracer_of({c.shape});
    for (int i = 0; i < 2000; ++i) {
      const ShapeSample s = c.shape->sample_area(random.square());
      EXPECT_FLOAT_EQ(s.pdf_area, 1 / c.shape->area());
      EXPECT_NEAR(length(s.point.ng), 1, 1e-5f);
      // A ray straight down onto the point finds it.
      const Ray ray{s.point.position + s.point.ng * 0.01f, -s.point.ng, 0.02f};
      Hit hit;
      if (!tracer->intersect(ray, hit)) continue;  // at an edge
      const SurfacePoint p = tracer->surface_point(ray, hit);
      EXPECT_LT(length(p.position - s.point.position), 1e-4f) << c.name;
      EXPECT_GT(dot(p.ng, s.point.ng), 0.999f);
      // What the derivatives promise: a small step along the surface is one in uv.
      const UvDerivatives d = c.shape->uv_derivatives(s.point);
      const float step = 1e-3f / (length(d.dpdu) + length(d.dpdv));
      for (const bool along_u : {true, false}) {
        const Vec3f moved = s.point.position + (along_u ? d.dpdu : d.dpdv) * step;
        const Ray probe{moved + s.point.ng * 0.01f, -s.point.ng, 0.02f};
        if (!(step < infinity) || !tracer->intersect(probe, hit)) continue;
        if (hit.primitive != s.point.primitive) continue;  // the next triangle has its own
        const Vec2f change = tracer->surface_point(probe, hit).uv - s.point.uv;
        if (std::fabs(change.x) > 0.5f || std::fabs(change.y) > 0.5f) continue;  // at the seam
        EXPECT_NEAR(along_u ? change.x : change.y, step, 0.1f * step + 2e-6f) << c.name;
        EXPECT_NEAR(along_u ? change.y : change.x, 0, 0.1f * step + 2e-6f) << c.name;
      }
    }
  }
}

struct View {
  const char* name;
  std::shared_ptr<const Shape> shape;
  Vec3f reference;
};

std::vector<View> views() {
  const auto ball = make_shape("sphere", {{"center", Vec3d(1, 2, 3), {}}, {"radius", 0.5, {}}});
  const auto cylinder = make_shape("cylinder", {{"radius", 0.5, {}}});
  const auto stretched = make_shape(
      "sphere",
      {{"to_world", Transform::rotate({1, 1, 0}, 20) * Transform::scale({1.0, 0.5, 0.7}), {}}});
  const double rows[4][4] = {{1, 0.2, 0.5, 0}, {0, 1.6, 0.1, 0}, {0, 0.1, 1, 0}, {0, 0, 0, 1}};
  const auto leaning =
      make_shape("cylinder", {{"radius", 0.5, {}}, {"to_world", Transform(rows), {}}});
  return {{"sphere near", ball, {1, 2, 3.6f}},
          {"sphere far", ball, {1, -3, 3}},
          {"sphere inside", ball, {1.1f, 2, 2.8f}},
          {"sphere stretched", stretched, {2, 1, 0.5f}},
          {"sphere stretched, near", stretched, {0.3f, 0.8f, 0.1f}},
          {"sphere stretched, inside", stretched, {0.5f, 0.1f, 0}},
          {"rectangle", make_shape("rectangle"), {0.5f, 2, 1}},
          {"rectangle near", make_shape("rectangle"), {0.8f, 0.5f, 0.3f}},
          {"disk", make_shape("disk"), {0.5f, 2, 1}},
          {"cube", make_shape("cube"), {0.5f, 2, 1.5f}},
          {"cylinder", cylinder, {2, 1, 0.5f}},
          {"cylinder, leaning", leaning, {2.5f, 1.5f, 0.5f}}};
}

/// ∫ pdf dω over the directions in which the shape is seen (all its layers where it is sampled by
/// area) must be 1. The rays are uniform in a cone around its bounds.
RunningStatistics integrated_pdf(const View& view, double factor) {
  const Bounds3f box = view.shape->bounds();
  const Vec3f to_center = center(box) - view.reference;
  const float sine = bounding_radius(box) / length(to_center);
  const bool inside = sine >= 1;
  const float h = inside ? 2.0f : 1 - safe_sqrt(1 - sine * sine);
  const Frame frame(normalize(inside ? Vec3f(0, 0, 1) : to_center));
  const bool sphere = std::string(view.name).starts_with("sphere");
  const auto tracer = tracer_of({view.shape});
  Random random(23);
  RunningStatistics statistics;
  for (int i = 0; i < samples; ++i) {
    const Vec3f d = frame.to_world(square_to_cone(random.square(), h));
    Ray ray{view.reference, d, infinity};
    double sum = 0;
    Hit hit;
    for (int layer = 0; layer < 10 && tracer->intersect(ray, hit); ++layer) {
      const SurfacePoint p = tracer->surface_point(ray, hit);
      sum += double(view.shape->pdf_toward(view.reference, p));
      if (sphere) break;  // samples only what is in front
      ray = spawn_ray(p, d);
    }
    statistics.add(factor * sum / double(cone_pdf(h)));
  }
  return statistics;
}

TEST(ShapeSampling, PdfTowardIntegratesToOne) {
  for (const View& view : views()) {
    const RunningStatistics s = integrated_pdf(view, 1);
    EXPECT_GT(z_test_p_value(s, 1), 1e-4) << view.name << ' ' << s.mean();
    EXPECT_LT(s.standard_error(), 0.01 * samples_divisor) << view.name;
  }
}

TEST(ShapeSampling, WrongPdfTowardFails) {
  if (samples_divisor > 1) GTEST_SKIP() << "needs all samples";
  for (const View& view : views())
    EXPECT_LT(z_test_p_value(integrated_pdf(view, 1.05), 1), 1e-4) << view.name;
}

/// Directions of sample_toward in cells of (cos θ, φ) against the integral of pdf_toward.
double directions_p_value(const View& view, double squeeze) {
  constexpr int n_cos = 12, n_phi = 12;
  const Bounds3f box = view.shape->bounds();
  const Vec3f to_center = center(box) - view.reference;
  const float sine = bounding_radius(box) / length(to_center);
  const bool inside = sine >= 1;
  const float h = inside ? 2.0f : 1 - safe_sqrt(1 - sine * sine);
  const Frame frame(normalize(inside ? Vec3f(0, 0, 1) : to_center));
  const auto cell = [&](const Vec3f& d) {
    const Vec3f local = frame.to_local(d);
    const float phi = std::atan2(local.y, local.x) * 0.5f * inv_pi + 0.5f;
    const float x = (1 - local.z) / h;
    return size_t(std::clamp(int(x * n_cos), 0, n_cos - 1) * n_phi +
                  std::clamp(int(phi * n_phi), 0, n_phi - 1));
  };
  const bool sphere = std::string(view.name).starts_with("sphere");
  const auto tracer = tracer_of({view.shape});
  std::vector<double> expected(n_cos * n_phi), observed(n_cos * n_phi);
  Random random(24);
  // Seen edge-on, the density of a curved surface has an integrable pole.
  const bool pole = std::string(view.name).starts_with("cylinder");
  const int side = (pole ? 1500 : 500) / (samples_divisor > 1 ? 2 : 1);
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const Vec3f d = frame.to_world(
          square_to_cone({(float(i) + 0.5f) / float(side), (float(j) + 0.5f) / float(side)}, h));
      Ray ray{view.reference, d, infinity};
      Hit hit;
      for (int layer = 0; layer < 10 && tracer->intersect(ray, hit); ++layer) {
        const SurfacePoint p = tracer->surface_point(ray, hit);
        expected[cell(d)] += double(view.shape->pdf_toward(view.reference, p) / cone_pdf(h)) /
                             (double(side) * double(side));
        if (sphere) break;
        ray = spawn_ray(p, d);
      }
    }
  const int count = 20000;
  double total = 0;
  for (const double e : expected) total += e;
  for (double& e : expected) e *= count / total;
  for (int i = 0; i < count; ++i) {
    Vec2f u = random.square();
    u.x = float(std::pow(double(u.x), squeeze));
    float pdf = 0;
    const ShapeSample s = view.shape->sample_toward(view.reference, u, pdf);
    EXPECT_GT(pdf, 0);
    EXPECT_NEAR(view.shape->pdf_toward(view.reference, s.point), pdf, 2e-3f * pdf) << view.name;
    observed[cell(normalize(s.point.position - view.reference))] += 1;
  }
  for (size_t i = 0; i < expected.size(); ++i)
    if (expected[i] < 5 && i != 0) {
      expected[0] += expected[i];
      observed[0] += observed[i];
      expected[i] = observed[i] = 0;
    }
  return chi_square_p_value(observed, expected);
}

TEST(ShapeSampling, DirectionsFollowPdfToward) {
  for (const View& view : views()) EXPECT_GT(directions_p_value(view, 1), 1e-4) << view.name;
}

TEST(ShapeSampling, SqueezedDirectionsFail) {
  for (const View& view : views()) EXPECT_LT(directions_p_value(view, 1.15), 1e-4) << view.name;
}

TEST(ShapeSampling, TinyConesStayExact) {
  // A lamp of a millimetre at up to 10 km: half angles down to 10⁻⁷.
  Random random(25);
  for (const float distance : {1.0f, 100.0f, 1e4f}) {
    const auto ball = make_shape("sphere", {{"radius", 1e-3, {}}});
    const Vec3f reference = random.direction() * distance;
    double sum_z = 0;
    const int n = 20000;
    for (int i = 0; i < n; ++i) {
      float pdf = 0;
      const ShapeSample s = ball->sample_toward(reference, random.square(), pdf);
      const double h = 0.5 * (1e-3 / double(distance)) * (1e-3 / double(distance));
      EXPECT_NEAR(double(pdf) * 2 * std::numbers::pi * h, 1, 1e-5);
      EXPECT_NEAR(length(s.point.position), 1e-3f, 1e-9f);
      EXPECT_GT(dot(s.point.ng, reference), -1e-4f * distance);
      sum_z += double(dot(s.point.ng, normalize(reference)));
    }
    // Uniform over the disk that is seen: mean of √(1 − r²) is 2/3.
    EXPECT_NEAR(sum_z / n, 2.0 / 3, 0.01);
  }
}

}  // namespace
}  // namespace kaustik::test
