#include "kaustik/integrator/pixel_plans.h"

#include <algorithm>
#include <atomic>

#include "kaustik/base/parallel.h"
#include "kaustik/base/to_integer.h"

namespace kaustik {
namespace {

/// Bounds of a pixel's radius, in widths of the pixel on the surface.
constexpr float least_widths = 1, most_widths = 6;
/// Most of the radius at later vertices, in distances of what the camera sees.
constexpr float most_other_radius = 0.03f;

Vec3f side_of(const SurfaceVertex& vertex) {
  return vertex.on_front() ? vertex.point().ng : -vertex.point().ng;
}

float mean_distance_of(const std::vector<PixelProbe>& probes) {
  double sum = 0;
  size_t hits = 0;
  for (const PixelProbe& probe : probes)
    if (probe.distance > 0) sum += double(probe.distance), ++hits;
  return hits > 0 ? float(sum / double(hits)) : 1.0f;
}

/// One for each block of a picture of few pixels; no more of large ones.
std::vector<PixelProbe> probes_of_whole_picture(const Scene& scene, int block_size) {
  constexpr int most_on_a_side = 64;
  const FilmSettings& film = scene.film();
  const int longest = std::max(film.size.x, film.size.y);
  PlanWindow whole;
  whole.size = film.size;
  whole.before = film.crop_offset;
  return make_pixel_probes(scene, whole,
                           std::max(block_size, (longest + most_on_a_side - 1) / most_on_a_side));
}

/// Of a disk where these edges hold.
PixelPlans::Surroundings surroundings_by(const SurfaceEdges& edges, const Vec3f& position,
                                         float radius) {
  PixelPlans::Surroundings result;
  result.edges = edges.around(position, radius);
  result.are_complete = edges.are_complete(position, radius);
  if (edges.are_clear(position, radius)) result.clear_flatness = edges.flatness();
  return result;
}

}  // namespace

PixelPlans::PixelPlans(const Scene& scene) {
  const FilmSettings& film = scene.film();
  window_ = PlanWindow(film, block_size);
  blocks_ = window_.blocks(block_size);
  probes_ = std::make_shared<const std::vector<PixelProbe>>(
      make_pixel_probes(scene, window_, block_size));
  plans_.assign(probes_->size(), PixelPlan());
  mean_distance_ = film.crop_size == film.size
                       ? mean_distance_of(*probes_)
                       : mean_distance_of(probes_of_whole_picture(scene, block_size));
}

void PixelPlans::choose_disks(const LightVertices& pilot, uint32_t paths, int wanted_neighbors,
                              float given, const std::stop_token& stop) {
  if (given > 0) {
    other_area_ = pi * sqr(given);
    for (PixelPlan& plan : plans_) plan.merge_area = other_area_;
    return;
  }
  const double share = double(pilot.path_count) / double(std::max(1u, paths));
  const int neighbors = to_integer(std::round(wanted_neighbors * share), 2, 1 << 30);
  parallel_blocks(plans_.size(), 16, [&](size_t begin, size_t end, size_t) {
    SidedTree<LightVertexData>::Neighbors found;
    for (size_t i = begin; i < end && !stop.stop_requested(); ++i) {
      const PixelProbe& probe = (*probes_)[i];
      if (!probe.found || pilot.tree.empty()) continue;
      pilot.tree.nearest(probe.vertex.position(), side_of(probe.vertex), false, neighbors,
                         most_widths * probe.pixel_width, found);
      const float radius = found.complete() ? std::sqrt(found.farthest_sq()) : float(infinity);
      plans_[i].merge_area = pi * sqr(std::clamp(radius, least_widths * probe.pixel_width,
                                                 most_widths * probe.pixel_width));
    }
  });
  fill_gaps();
  const float typical = pilot.tree.typical_radius(neighbors, 0.5f);
  other_area_ = pi * sqr(std::min(typical, most_other_radius * mean_distance_));
}

void PixelPlans::find_edges(const Scene& scene, float widths, float given, uint64_t& rays,
                            const std::stop_token& stop) {
  auto edges = std::make_shared<std::vector<SurfaceEdges>>(probes_->size());
  std::atomic<uint64_t> counted{0};
  parallel_blocks(edges->size(), 16, [&](size_t begin, size_t end, size_t) {
    uint64_t block_rays = 0;
    for (size_t i = begin; i < end && !stop.stop_requested(); ++i) {
      const PixelProbe& probe = (*probes_)[i];
      const float reach =
          (given > 0 ? given : widths * probe.pixel_width) + float(block_size) * probe.pixel_width;
      if (probe.found && reach > 0)
        (*edges)[i] = SurfaceEdges(scene, probe.vertex, reach, block_rays);
    }
    counted += block_rays;
  });
  rays += counted;
  edges_ = std::move(edges);
}

const SurfaceEdges* PixelPlans::edges_at(const Vec2f& raster, const SurfaceVertex& vertex) const {
  if (!edges_) return nullptr;
  const Vec2i block = block_at(raster);
  const SurfaceEdges& own = (*edges_)[index_of(block)];
  if (own.hold_at(vertex)) return &own;
  for (int y = std::max(0, block.y - 1); y <= std::min(blocks_.y - 1, block.y + 1); ++y)
    for (int x = std::max(0, block.x - 1); x <= std::min(blocks_.x - 1, block.x + 1); ++x) {
      const SurfaceEdges& other = (*edges_)[index_of({x, y})];
      if (other.hold_at(vertex)) return &other;
    }
  return nullptr;
}

PixelPlans::Surroundings PixelPlans::surroundings(const Vec2f& raster, const SurfaceVertex& vertex,
                                                  float radius) const {
  const SurfaceEdges* const edges = edges_at(raster, vertex);
  return edges ? surroundings_by(*edges, vertex.position(), radius) : Surroundings();
}

PixelPlans::Surroundings PixelPlans::surroundings(size_t probe, float radius) const {
  if (!edges_) return {};
  const Vec3f position = (*probes_)[probe].vertex.position();
  const SurfaceEdges& edges = (*edges_)[probe];
  return surroundings_by(edges, position, radius);
}

PixelPlans PixelPlans::with(std::vector<PixelPlan> plans) const {
  PixelPlans result = *this;
  result.plans_ = std::move(plans);
  result.fill_gaps();
  return result;
}

void PixelPlans::fill_gaps() {
  const auto width = size_t(blocks_.x), height = size_t(blocks_.y);
  std::vector<bool> row_is_known(height);
  for (size_t y = 0; y < height; ++y) {
    // From the left, and what comes before the first of a row from the right.
    size_t first = width;
    for (size_t x = 0; x < width; ++x) {
      const size_t i = y * width + x;
      if ((*probes_)[i].found)
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

}  // namespace kaustik
