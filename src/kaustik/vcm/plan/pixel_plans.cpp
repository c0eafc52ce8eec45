#include "kaustik/vcm/plan/pixel_plans.h"

#include <algorithm>

#include "kaustik/base/parallel.h"
#include "kaustik/base/to_integer.h"

namespace kaustik {
namespace {

/// Most of the radius at later vertices, in distances of what the camera sees.
constexpr float most_other_radius = 0.03f;

// Of a surface, at two places: cosine between the normals, and distance from the plane of one,
// relative to that between them and to the width of a pixel.
constexpr float same_normal = 0.9f, same_height = 0.2f, least_height = 0.05f;
/// Of what no probe shows, such as a bevel: it may be as narrow as that, in widths of a pixel …
constexpr float unknown_widths = 1.5f;
/// … and then little merges there: so many paths go on at least.
constexpr float unknown_survival = 0.35f;

/// Of a gauge's disk, relative to the largest.
constexpr float least_gauge_radius = 1.0f / 32;
/// A gauge has no neighbours that are as bright: its disk takes so many times as many vertices as
/// that of a pixel.
constexpr size_t gauge_share = 8;

/// Of the disk of a gauge, m, where that of a pixel takes so many vertices.
float gauge_radius(const GaugeVertices& at_gauges, size_t gauge, float largest, size_t of_pixel) {
  const auto vertices = at_gauges.of(gauge);
  const size_t neighbors = gauge_share * of_pixel;
  if (vertices.size() < neighbors) return largest;
  std::vector<float> offsets;
  for (const GaugeVertex& vertex : vertices) offsets.push_back(vertex.offset_sq);
  const auto farthest = offsets.begin() + std::ptrdiff_t(neighbors - 1);
  std::nth_element(offsets.begin(), farthest, offsets.end());
  return std::clamp(std::sqrt(*farthest), least_gauge_radius * largest, largest);
}

Vec3f side_of(const SurfaceVertex& vertex) {
  return vertex.on_front() ? vertex.point().ng : -vertex.point().ng;
}

/// Whether a point with that normal lies on what the probe shows, as far as both tell.
bool is_same_surface(const PixelProbe& probe, const Vec3f& position, const Vec3f& side) {
  if (!probe.found) return false;
  const Vec3f its = side_of(probe.vertex), offset = position - probe.vertex.position();
  return dot(side, its) > same_normal &&
         std::fabs(dot(offset, its)) <=
             same_height * length(offset) + least_height * probe.pixel_width;
}

}  // namespace

float noise_in_common(float spread) {
  spread = std::min(spread, spread_of_all);
  float left = 0, left_of_own = 0;
  for (const float side : {1.0f, 3.0f, 9.0f}) {
    left += (1 + spread) / (sqr(side) + spread);
    left_of_own += 1 / sqr(side);
  }
  return left / left_of_own;
}

PixelPlan PixelPlan::of_unknown_surface(float pixel_width) const {
  PixelPlan result = *this;
  result.merge_area = std::min(merge_area, pi * sqr(unknown_widths * pixel_width));
  result.survival = std::max(survival, unknown_survival);
  result.evenness = result.covered = 1;
  result.merging_in_common = noise_in_common(spread_of_disk(unknown_widths));
  return result;
}

PixelPlans::PixelPlans(const Scene& scene)
    : seen_(std::make_shared<const SeenSurfaces>(scene)), plans_(seen_->probes().size()) {}

void PixelPlans::choose_disks(const LightVertices& pilot, uint32_t paths, int wanted_neighbors,
                              float given, const std::stop_token& stop) {
  are_disks_given_ = given > 0;
  if (are_disks_given_) {
    other_area_ = pi * sqr(given);
    for (PixelPlan& plan : plans_) plan.merge_area = other_area_;
    return;
  }
  const double share = double(pilot.path_count) / double(std::max(1u, paths));
  const int neighbors = to_integer(std::round(wanted_neighbors * share), 2, 1 << 30);
  parallel_blocks(plans_.size(), 16, [&](size_t begin, size_t end, size_t) {
    SidedTree<LightVertexData>::Neighbors found;
    for (size_t i = begin; i < end && !stop.stop_requested(); ++i) {
      const PixelProbe& probe = seen_->probes()[i];
      if (probe.gauge >= 0) {
        plans_[i].merge_area =
            pi * sqr(gauge_radius(pilot.at_gauges, size_t(probe.gauge),
                                  GaugeDisks::largest_radius(probe.distance), size_t(neighbors)));
        continue;
      }
      if (!probe.found || pilot.tree.empty()) continue;
      pilot.tree.nearest(probe.vertex.position(), side_of(probe.vertex), false, neighbors,
                         most_disk_widths * probe.pixel_width, found);
      const float radius = found.complete() ? std::sqrt(found.farthest_sq()) : float(infinity);
      plans_[i].merge_area = pi * sqr(std::clamp(radius, least_disk_widths * probe.pixel_width,
                                                 most_disk_widths * probe.pixel_width));
    }
  });
  fill_gaps();
  const float typical = pilot.tree.typical_radius(neighbors, 0.5f);
  other_area_ = pi * sqr(std::min(typical, most_other_radius * seen_->mean_distance()));
}

PixelPlan PixelPlans::at(const Vec2f& raster, float shrinkage, const Vec3f& position,
                         const Vec3f& side) const {
  const size_t own = seen_->grid().index_at(raster);
  const std::vector<PixelProbe>& probes = seen_->probes();
  if (are_disks_given_ || probes.empty() || is_same_surface(probes[own], position, side))
    return at(raster, shrinkage);
  const PixelPlan* found = nullptr;
  const PixelProbe* nearest = nullptr;
  float least_sq = infinity, nearest_sq = infinity;
  seen_->grid().visit_around(own, [&](size_t i) {
    if (!probes[i].found) return;
    const float distance_sq = length_sq(position - probes[i].vertex.position());
    if (distance_sq < nearest_sq) {
      nearest_sq = distance_sq;
      nearest = &probes[i];
    }
    if (!(distance_sq < least_sq) || !is_same_surface(probes[i], position, side)) return;
    least_sq = distance_sq;
    found = &plans_[i];
  });
  PixelPlan plan = found ? *found : plans_[own];
  plan.merge_area *= shrinkage;
  return found || !nearest ? plan : plan.of_unknown_surface(nearest->pixel_width);
}

void PixelPlans::find_edges(const Scene& scene, float widths, float given, uint64_t& rays,
                            const std::stop_token& stop) {
  auto seen = std::make_shared<SeenSurfaces>(*seen_);
  seen->find_edges(scene, widths, given, rays, stop);
  seen_ = std::move(seen);
}

PixelPlans PixelPlans::with(std::vector<PixelPlan> plans) const {
  PixelPlans result = *this;
  result.plans_ = std::move(plans);
  result.fill_gaps();
  return result;
}

void PixelPlans::fill_gaps() {
  const Vec2i blocks = seen_->grid().count();
  const auto width = size_t(blocks.x), height = size_t(blocks.y);
  std::vector<bool> row_is_known(height);
  for (size_t y = 0; y < height; ++y) {
    // From the left, and what comes before the first of a row from the right.
    size_t first = width;
    for (size_t x = 0; x < width; ++x) {
      const size_t i = y * width + x;
      if (seen_->probes()[i].found)
        first = std::min(first, x);
      else if (first < width)
        plans_[i] = plans_[i - 1];
    }
    if (first == width) continue;
    row_is_known[y] = true;
    for (size_t x = 0; x < first; ++x) plans_[y * width + x] = plans_[y * width + first];
  }
  // Rows of which nothing is known, from above, and the first ones from below.
  const auto copy_row = [&](size_t to, size_t from) {
    if (row_is_known[to] || !row_is_known[from]) return;
    std::copy_n(plans_.begin() + std::ptrdiff_t(from * width), width,
                plans_.begin() + std::ptrdiff_t(to * width));
    row_is_known[to] = true;
  };
  for (size_t y = 1; y < height; ++y) copy_row(y, y - 1);
  for (size_t y = height - 1; y-- > 0;) copy_row(y, y + 1);
}

void PixelPlans::write(ByteWriter& writer) const {
  writer.put_array(plans_);
  writer.put(other_area_);
  writer.put(uint8_t(are_disks_given_ ? 1 : 0));
  writer.put(uint8_t(spread_ ? 1 : 0));
  if (!spread_) return;
  writer.put(spread_->begin);
  writer.put_array(spread_->counts);
  writer.put_array(spread_->first_indices);
  writer.put_array(spread_->next_indices);
}

PixelPlans PixelPlans::read(ByteReader& reader, std::shared_ptr<const SeenSurfaces> seen) {
  PixelPlans result;
  result.seen_ = std::move(seen);
  const size_t blocks = result.seen_->grid().size();
  result.plans_ = reader.get_array<PixelPlan>(blocks);
  result.other_area_ = reader.get<float>();
  result.are_disks_given_ = reader.get_flag();
  if (!reader.get_flag()) return result;
  SampleSpread spread;
  spread.begin = reader.get<uint32_t>();
  spread.counts = reader.get_array<uint32_t>(blocks);
  spread.first_indices = reader.get_array<uint32_t>(blocks);
  spread.next_indices = reader.get_array<uint32_t>(blocks);
  result.spread_ = std::make_shared<const SampleSpread>(std::move(spread));
  return result;
}

}  // namespace kaustik
