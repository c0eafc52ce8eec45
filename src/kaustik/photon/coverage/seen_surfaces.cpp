#include "kaustik/photon/coverage/seen_surfaces.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "kaustik/base/parallel.h"
#include "kaustik/base/to_integer.h"

namespace kaustik {
namespace {

/// On a side of a picture.
constexpr double usual_blocks = 100;

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
  const int of_few = (longest + most_on_a_side - 1) / most_on_a_side;
  return make_pixel_probes(scene, BlockGrid(whole, std::max(block_size, of_few)));
}

/// Of a disk where these edges hold.
DiskBounds bounds_by(const SurfaceEdges& edges, const Vec3f& position, float radius) {
  DiskBounds result;
  result.edges = edges.around(position, radius);
  result.are_complete = edges.are_complete(position, radius);
  if (edges.are_clear(position, radius)) result.clear_flatness = edges.flatness();
  return result;
}

}  // namespace

int SeenSurfaces::block_size_of(const Scene& scene) {
  if (scene.camera().traits().are_pixels_apart()) return 1;
  const Vec2i& size = scene.film().size;
  const double side = std::sqrt(double(size.x) * double(size.y));
  return to_integer(std::round(side / usual_blocks), least_block_size, most_block_size);
}

SeenSurfaces::SeenSurfaces(const Scene& scene)
    : grid_(PlanWindow(scene.film(), block_size_of(scene)), block_size_of(scene)),
      probes_(make_pixel_probes(scene, grid_)) {
  const FilmSettings& film = scene.film();
  mean_distance_ = film.crop_size == film.size
                       ? mean_distance_of(probes_)
                       : mean_distance_of(probes_of_whole_picture(scene, grid_.block_size()));
}

void SeenSurfaces::find_edges(const Scene& scene, float widths, float given, uint64_t& rays,
                              const std::stop_token& stop) {
  std::vector<SurfaceEdges> edges(probes_.size());
  std::atomic<uint64_t> counted{0};
  parallel_blocks(edges.size(), 16, [&](size_t begin, size_t end, size_t) {
    uint64_t block_rays = 0;
    for (size_t i = begin; i < end && !stop.stop_requested(); ++i) {
      const PixelProbe& probe = probes_[i];
      const float reach = (given > 0 ? given : widths * probe.pixel_width) +
                          float(grid_.block_size()) * probe.pixel_width;
      if (probe.found && reach > 0) edges[i] = SurfaceEdges(scene, probe.vertex, reach, block_rays);
    }
    counted += block_rays;
  });
  rays += counted;
  edges_ = std::move(edges);
}

const SurfaceEdges* SeenSurfaces::edges_at(const Vec2f& raster, const SurfaceVertex& vertex) const {
  if (edges_.empty()) return nullptr;
  const size_t own = grid_.index_at(raster);
  if (edges_[own].hold_at(vertex)) return &edges_[own];
  const SurfaceEdges* found = nullptr;
  grid_.visit_around(own, [&](size_t other) {
    if (!found && edges_[other].hold_at(vertex)) found = &edges_[other];
  });
  return found;
}

DiskBounds SeenSurfaces::disk_bounds(const Vec2f& raster, const SurfaceVertex& vertex,
                                     float radius) const {
  const SurfaceEdges* const edges = edges_at(raster, vertex);
  return edges ? bounds_by(*edges, vertex.position(), radius) : DiskBounds();
}

DiskBounds SeenSurfaces::disk_bounds(size_t probe, float radius) const {
  if (edges_.empty()) return {};
  return bounds_by(edges_[probe], probes_[probe].vertex.position(), radius);
}

}  // namespace kaustik
