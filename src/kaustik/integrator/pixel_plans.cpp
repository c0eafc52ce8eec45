#include "kaustik/integrator/pixel_plans.h"

#include <algorithm>

#include "kaustik/base/parallel.h"

namespace kaustik {
namespace {

/// Bounds of a pixel's radius, in widths of the pixel on the surface.
constexpr float least_widths = 1, most_widths = 6;
/// Most of the radius at later vertices, in distances of what the camera sees.
constexpr float most_other_radius = 0.03f;

Vec3f side_of(const SurfaceVertex& vertex) {
  return vertex.on_front() ? vertex.point().ng : -vertex.point().ng;
}

}  // namespace

PixelPlans::PixelPlans(const Scene& scene, const LightVertices& pilot, uint32_t paths,
                       int wanted_neighbors, float given) {
  const double share = double(pilot.path_count) / double(std::max(1u, paths));
  const int neighbors = std::max(2, int(std::lround(wanted_neighbors * share)));
  const Vec2i size = scene.film().crop_size;
  blocks_ = (size + Vec2i(block_size - 1)) / block_size;
  probes_ = std::make_shared<const std::vector<PixelProbe>>(
      make_pixel_probes(scene, blocks_, block_size));
  const std::vector<PixelProbe>& probes = *probes_;
  const size_t count = probes.size();
  PixelPlan same;
  same.merge_area = pi * sqr(given);
  plans_.assign(count, same);
  parallel_blocks(count, 16, [&](size_t begin, size_t end, size_t) {
    SidedTree<LightVertexData>::Neighbors found;
    for (size_t i = begin; i < end; ++i) {
      const PixelProbe& probe = probes[i];
      if (!probe.found || pilot.tree.empty()) continue;
      if (!(given > 0)) {
        pilot.tree.nearest(probe.vertex.position(), side_of(probe.vertex), false, neighbors,
                           most_widths * probe.pixel_width, found);
        const float radius = found.complete() ? std::sqrt(found.farthest_sq()) : float(infinity);
        plans_[i].merge_area = pi * sqr(std::clamp(radius, least_widths * probe.pixel_width,
                                                   most_widths * probe.pixel_width));
      }
    }
  });
  double distance_sum = 0;
  size_t hits = 0;
  for (size_t i = 0; i < count; ++i)
    if (probes[i].distance > 0) distance_sum += double(probes[i].distance), ++hits;
  mean_distance_ = hits > 0 ? float(distance_sum / double(hits)) : 1.0f;
  if (given > 0) {
    other_area_ = pi * sqr(given);
    return;
  }
  fill_gaps();
  const float typical = pilot.tree.typical_radius(neighbors, 0.5f);
  other_area_ = pi * sqr(std::min(typical, most_other_radius * mean_distance_));
}

PixelPlans PixelPlans::with(std::vector<PixelPlan> plans) const {
  PixelPlans result = *this;
  result.plans_ = std::move(plans);
  result.fill_gaps();
  return result;
}

void PixelPlans::fill_gaps() {
  const auto row = size_t(blocks_.x);
  size_t known = plans_.size();
  const auto copy_if_gap = [&](size_t i) {
    if ((*probes_)[i].found)
      known = i;
    else if (known < plans_.size())
      plans_[i] = plans_[known];
  };
  // Along the rows from left to right; what comes before the first of all that is known, backward.
  for (size_t i = 0; i < plans_.size(); ++i) {
    if (i % row == 0 && i >= row) known = i - row;
    copy_if_gap(i);
  }
  known = plans_.size();
  for (size_t i = plans_.size(); i-- > 0;)
    if (!(plans_[i].merge_area > 0))
      copy_if_gap(i);
    else
      known = i;
}

}  // namespace kaustik
