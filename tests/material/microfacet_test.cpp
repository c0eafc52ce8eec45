#include "kaustik/material/microfacet.h"

#include <gtest/gtest.h>

#include "tests/material/bsdf_support.h"

namespace kaustik {
namespace {

using Kind = MicrofacetDistribution::Kind;

/// Integral over all normals m of f(m).
double over_normals(const std::function<double(const Vec3f&)>& f) {
  const DirectionGrid grid(Vec3f(0, 0, 1));
  double sum = 0;
  for (size_t cell = 0; cell < grid.size(); ++cell)
    sum += grid.integrate(cell, [&](const Vec3f& m) { return Vec3d(f(m), 0, 0); }).x;
  return sum;
}

std::vector<MicrofacetDistribution> distributions() {
  std::vector<MicrofacetDistribution> all;
  for (const Kind kind : {Kind::beckmann, Kind::ggx})
    for (const auto& [x, y] : {std::pair{0.1f, 0.1f}, {0.5f, 0.5f}, {0.2f, 0.6f}, {1.0f, 1.0f}})
      all.emplace_back(kind, x, y);
  return all;
}

// Walter et al. 2007, equation 4: the facets cover the surface once.
TEST(microfacets, project_onto_the_surface_once) {
  for (const MicrofacetDistribution& d : distributions())
    EXPECT_NEAR(over_normals([&](const Vec3f& m) { return d.density(m) * m.z; }), 1, 2e-4);
}

// Heitz 2014, equation 9: what w sees of the facets is the projected surface; this is what ties
// the masking to the distribution, and a masking that is 2 % off is found.
TEST(microfacets, visible_area_is_the_projected_surface) {
  for (const MicrofacetDistribution& d : distributions())
    for (const Vec3f& w : test::outgoing_directions()) {
      const double visible = over_normals(
          [&](const Vec3f& m) { return d.density(m) * std::max(0.0f, dot(w, m)) * d.masking(w); });
      EXPECT_NEAR(visible / w.z, 1, 5e-4);
      EXPECT_GT(std::fabs(visible * 1.02 / w.z - 1), 5e-4);
    }
}

TEST(microfacets, density_of_visible_normals_integrates_to_one) {
  for (const MicrofacetDistribution& d : distributions())
    for (const Vec3f& w : test::outgoing_directions())
      EXPECT_NEAR(over_normals([&](const Vec3f& m) { return dot(w, m) > 0 ? d.pdf(w, m) : 0.0f; }),
                  1, 5e-4);
}

TEST(microfacets, turn_with_the_axes) {
  const MicrofacetDistribution a(Kind::ggx, 0.1f, 0.4f), b(Kind::ggx, 0.4f, 0.1f);
  const Vec3f m = normalize(Vec3f(0.2f, 0.05f, 1)), turned(m.y, m.x, m.z);
  EXPECT_FLOAT_EQ(a.density(m), b.density(turned));
  EXPECT_FLOAT_EQ(a.masking(m), b.masking(turned));
  EXPECT_GT(a.density(turned), 2 * a.density(m));
  EXPECT_FALSE(a.is_isotropic());
}

}  // namespace
}  // namespace kaustik
