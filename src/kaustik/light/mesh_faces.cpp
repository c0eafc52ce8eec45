#include "kaustik/light/mesh_faces.h"

#include "kaustik/base/sampler.h"
#include "kaustik/base/warp.h"
#include "kaustik/geometry/mesh_surface.h"
#include "kaustik/light/power_distribution.h"

namespace kaustik {
namespace {

/// Depth of the tree down to which its nodes are told apart by the point that asks.
int informed_depth(int level) {
  return level <= 0 ? LightTree::whole_depth : std::max(1, 2 / level);
}

/// Gives every triangle the share of its mean radiance, by a few points. Those may miss what is
/// bright: none gets less than a tenth of what it would have by its area.
void weigh_by_radiance(const TriangleMesh& mesh, const EmissionPattern& pattern,
                       std::vector<LightTree::Item>& items) {
  constexpr uint32_t points = 16;
  std::vector<double> radiances;
  double power = 0, area = 0;
  for (const LightTree::Item& item : items) {
    Spectrum sum;
    for (uint32_t i = 0; i < points; ++i) {
      const auto triangle = uint64_t(item.light);
      const Vec2f b = square_to_triangle(Sampler::of(Quadrature::mesh_face, i, triangle).next_2d());
      sum += pattern.radiance(triangle_surface_point(mesh, uint32_t(item.light), b.x, b.y), {});
    }
    radiances.push_back(importance_of(sum));
    power += radiances.back() * item.power;
    area += item.power;
  }
  if (!(power > 0)) return;
  for (size_t i = 0; i < items.size(); ++i)
    items[i].power *= std::max(radiances[i] / power * area, 0.1);
}

}  // namespace

MeshFaces::MeshFaces(const Shape& shape, bool two_sided, const EmissionPattern* pattern)
    : shape_(shape) {
  const TriangleMesh& mesh = *shape.mesh();
  std::vector<LightTree::Item> items;
  inverse_share_.assign(mesh.triangles.size(), 0.0f);
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& corner = mesh.triangles[i];
    const Vec3d a(mesh.positions[corner[0]]), b(mesh.positions[corner[1]]),
        c(mesh.positions[corner[2]]);
    const Vec3d twice_area = (b - a).cross(c - a);
    const double area = 0.5 * twice_area.length();
    if (!(area > 0)) continue;
    LightTree::Item item{int(i), {}, area};
    for (const uint32_t vertex : corner) item.bounds.position.extendBy(mesh.positions[vertex]);
    if (!two_sided) {
      item.bounds.axis = Vec3f(twice_area / (2 * area));
      item.bounds.cos_spread = 1;
      item.bounds.cos_angle = 0;
    }
    items.push_back(item);
    inverse_share_[i] = float(double(shape.area()) / area);
  }
  if (pattern) weigh_by_radiance(mesh, *pattern, items);
  tree_ = LightTree(std::move(items), mesh.triangles.size());
}

ShapeSample MeshFaces::sample_toward(const LightQuery& query, const Vec2f& u,
                                     float& pdf_solid_angle) const {
  float rest = u.x;
  const int depth = informed_depth(query.level);
  ChoiceWeights weights;
  tree_.weigh(query, weights, depth);
  const LightSelector::Choice choice = tree_.choose(query, weights, rest, depth);
  const auto triangle = uint32_t(choice.light);
  const Vec2f b = square_to_triangle({rest, u.y});
  ShapeSample sample{triangle_surface_point(*shape_.mesh(), triangle, b.x, b.y), 0};
  const float ratio = density_ratio(triangle, choice.probability);
  pdf_solid_angle = shape_.pdf_toward(query.reference, sample.point) * ratio;
  sample.pdf_area = ratio / shape_.area();
  return sample;
}

float MeshFaces::pdf_toward(const LightQuery& query, const SurfacePoint& point) const {
  const int depth = informed_depth(query.level);
  ChoiceWeights weights;
  tree_.weigh(query, weights, depth);
  const float probability = tree_.probability(query, weights, int(point.primitive), depth);
  return shape_.pdf_toward(query.reference, point) * density_ratio(point.primitive, probability);
}

}  // namespace kaustik
