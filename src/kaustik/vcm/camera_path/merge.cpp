#include "kaustik/vcm/camera_path/merge.h"

#include <algorithm>

#include "kaustik/base/prefetch.h"
#include "kaustik/photon/coverage/merge_disk.h"

namespace kaustik {
namespace {

/// Where many light vertices merge one by one, the samples of a pixel share them out, in parts that
/// are no smaller: all samples merge with the same vertices, and a part costs about as much as the
/// way there.
constexpr size_t least_in_part = 64;

/// Chance with which the bias is estimated: it takes rays.
constexpr float bias_chance = 0.25f;
// A bias that grows by the area is told too large by (1 − narrow_radius²)/(1 − narrow_radius).
static_assert(smooth_bias_share * (1 + narrow_radius) == 1);

}  // namespace

void SurfaceMerging::merge() {
  if (walk_.gauge() >= 0) return merge_at_gauge();
  const SurfaceVertex& vertex = walk_.vertex();
  const Lobes lobes = vertex.lobes() & (Lobes::diffuse | Lobes::glossy);
  if (!any(lobes) || in_.light.tree.empty() || !in_.weights.merges_at(vertices_.list())) return;
  const auto wanted = [&](Lobes lobe) {
    return any(lobes & lobe) && (walk_.wants(walk_.component_of(lobe, true)) ||
                                 walk_.wants(walk_.component_of(lobe, false)));
  };
  if (!wanted(Lobes::diffuse) && !wanted(Lobes::glossy)) return;
  const float widest = vertices_.merge_radius();
  if (!(widest > 0)) return;
  const bool is_matt = vertices_.is_at_first() && vertex.is_matt();
  if (is_matt && in_.focused_matt && is_only_focused_wanted() &&
      !in_.focused_matt->may_merge(vertex.position(), widest))
    return;
  const DiskCoverage covered(in_.scene, MergeDisk(vertex, widest), walk_.rays(),
                             disk_bounds(widest).clear_flatness);
  const float radius = std::min(widest, std::max(covered.clear_radius(), walk_.footprint().width));
  const DiskBounds bounds = disk_bounds(radius);
  const MergeDisk disk = bounds.are_clear() ? MergeDisk(vertex, radius, bounds.clear_flatness)
                                            : MergeDisk(vertex, radius);
  const DiskWeights weights = disk_weights(disk, bounds);
  const bool is_all_reached = bounds.are_clear() || !in_.visibility;
  MergedLight light;
  if (is_matt)
    light =
        is_all_reached ? merged_matt(disk, weights, nullptr) : reached_matt(disk, weights, covered);
  else
    light = is_all_reached ? merged(disk, weights, lobes, nullptr)
                           : reached(disk, weights, lobes, covered);
  if (light.is_zero()) return;
  const auto paths = float(in_.light.path_count);
  // Numbers of their own: how many there are is not known beforehand.
  light.scale(
      weights.wide.scale *
      covered.inverse_share(radius, weights.bounds.edges, walk_.sampler().fork(Fork::merge_cover)) /
      paths);
  Spectrum total;
  for (int c = 0; c < component_count; ++c) {
    const Spectrum& sum = light.of[size_t(c)];
    if (!sum.is_zero()) walk_.add(Component(c), sum);
    total += sum;
  }
  // As if it grew by the radius, as it does where light has an edge: see smooth_bias_share.
  if (!(walk_.sampler().fork(Fork::merge_bias).next_1d() < bias_chance)) return;
  const float narrow_coverage = covered.inverse_share(
      radius * narrow_radius, weights.bounds.edges, walk_.sampler().fork(Fork::narrow_merge_cover));
  const Spectrum narrow = light.narrow * (weights.narrow.scale * narrow_coverage / paths);
  walk_.add_bias((total - narrow) * (1 / ((1 - narrow_radius) * bias_chance)));
}

void SurfaceMerging::merge_at_gauge() {
  const float radius = vertices_.merge_radius();
  if (in_.light.at_gauges.empty() || !(radius > 0)) return;
  constexpr float wide_factor = GaugeDisks::wide_factor;
  MergedLight light;
  Spectrum wide;
  visit_at_gauge(wide_factor * radius, uint32_t(std::max(1.0f, in_.camera_samples)),
                 [&](const GaugeVertex& at, const Spectrum& flux, const BsdfValues& bsdf,
                     const PathHalves& path) {
                   const Component component = walk_.component_of(Lobes::diffuse, at.data.specular);
                   if (!walk_.wants(component)) return;
                   const Spectrum reflected =
                       flux * bsdf.of(Lobes::diffuse) * in_.weights.merge(path);
                   const float share = at.offset_sq / sqr(radius);
                   if (share < 1) light.of[size_t(component)] += reflected * (1 - share);
                   wide += reflected * (1 - share / sqr(wide_factor));
                 });
  const GaugeDisks& disks = in_.light.at_gauges.disks();
  const auto gauge = size_t(walk_.gauge());
  // Of the parabolic kernel: 2/(π r²).
  const float scale = 2 * inv_pi / (sqr(radius) * float(in_.light.path_count));
  light.scale(scale * disks.inverse_share(gauge));
  Spectrum total;
  for (int c = 0; c < component_count; ++c) {
    const Spectrum& sum = light.of[size_t(c)];
    if (!sum.is_zero()) walk_.add(Component(c), sum);
    total += sum;
  }
  // As elsewhere the bias is taken to grow by the radius. It is told by a wider disk, not by a
  // narrow one: there are no pixels around to take the noise off that.
  wide *= scale / sqr(wide_factor) * disks.inverse_share_of_wide(gauge);
  walk_.add_bias((wide - total) * (1 / (wide_factor - 1)));
}

bool SurfaceMerging::MergedLight::is_zero() const {
  return std::all_of(of.begin(), of.end(), [](const Spectrum& sum) { return sum.is_zero(); });
}

SurfaceMerging::Draws SurfaceMerging::draws_of(const MergedLight& light) const {
  const float u = walk_.sampler().fork(Fork::merge_sight).next_1d();
  Draws draws;
  for (size_t c = 0; c < draws.size(); ++c)
    if (!light.of[c].is_zero()) draws[c].emplace(light.of[c], u);
  return draws;
}

template <typename IsReached>
void SurfaceMerging::leave_drawn(const Draws& draws, const IsReached& is_reached,
                                 MergedLight& light) {
  // Most often components draw the same part too.
  size_t asked = ~size_t(0);
  bool answer = false;
  const auto ask = [&](size_t part) {
    if (part != asked) answer = is_reached(part);
    asked = part;
    return answer;
  };
  Spectrum before, after;
  for (size_t c = 0; c < draws.size(); ++c) {
    if (!draws[c]) continue;
    before += light.of[c];
    light.of[c] = draws[c]->remaining(light.of[c], ask);
    after += light.of[c];
  }
  for (int lane = 0; lane < Spectrum::lane_count; ++lane)
    light.narrow.set(lane,
                     before[lane] > 0 ? light.narrow[lane] * (after[lane] / before[lane]) : 0.0f);
}

SurfaceMerging::MergedLight SurfaceMerging::reached_matt(const MergeDisk& disk,
                                                         const DiskWeights& weights,
                                                         const DiskCoverage& covered) const {
  const auto each = scratch_.list<MattMerging::Factors>();
  MergedLight light = merged_matt(disk, weights, &*each);
  if (light.is_zero()) return light;
  const SurfaceVertex& vertex = walk_.vertex();
  const Spectrum reflected = vertex.diffuse_value();
  Draws draws = draws_of(light);
  for (const auto kind : {MattMerging::other, MattMerging::after_specular}) {
    const bool specular = kind == MattMerging::after_specular;
    if (auto& draw = draws[size_t(walk_.component_of(Lobes::diffuse, specular))])
      matt_merging().offer(*each, kind, reflected, *draw);
  }
  leave_drawn(
      draws,
      [&](size_t number) {
        return covered.reaches(disk.radius(),
                               matt_merging().position(uint32_t(number)) - vertex.position());
      },
      light);
  return light;
}

SurfaceMerging::MergedLight SurfaceMerging::reached(const MergeDisk& disk,
                                                    const DiskWeights& weights, Lobes lobes,
                                                    const DiskCoverage& covered) const {
  const auto list = scratch_.list<MergedPart>();
  std::vector<MergedPart>& each = *list;
  MergedLight light = merged(disk, weights, lobes, &each);
  if (light.is_zero()) return light;
  Draws draws = draws_of(light);
  for (size_t i = 0; i < each.size(); ++i)
    if (auto& draw = draws[size_t(each[i].component)]) draw->offer(i, each[i].light);
  leave_drawn(
      draws, [&](size_t i) { return covered.reaches(disk.radius(), each[i].offset); }, light);
  return light;
}

void SurfaceMerging::MergedLight::scale(float factor) {
  for (Spectrum& sum : of) sum *= factor;
}

DiskBounds SurfaceMerging::disk_bounds(float radius) const {
  if (!vertices_.is_at_first()) return {};
  return in_.seen.disk_bounds(walk_.raster(), walk_.vertex(), radius);
}

SurfaceMerging::DiskWeights SurfaceMerging::disk_weights(const MergeDisk& disk,
                                                         const DiskBounds& bounds) const {
  const DiskEdges& edges = bounds.edges;
  const Frame frame(disk.side());
  DiskWeights weights{
      bounds, DiskKernel(frame, disk.radius(), edges, KernelShape::parabolic),
      DiskKernel(frame, disk.radius() * narrow_radius, edges, KernelShape::parabolic)};
  // Slopes are for all of what edges leave, not for a part of it that is covered.
  if (!vertices_.plan().has_slopes || !bounds.are_complete ||
      !(bounds.are_clear() || !in_.visibility)) {
    weights.wide.level();
    weights.narrow.level();
  }
  return weights;
}

SurfaceMerging::MergedLight SurfaceMerging::merged_matt(
    const MergeDisk& disk, const DiskWeights& weights,
    std::vector<MattMerging::Factors>* each) const {
  const SurfaceVertex& vertex = walk_.vertex();
  const MattLight light =
      matt_merging().merge({.center = vertex.position(),
                            .normal = disk.side(),
                            .radius = disk.radius(),
                            .flatness = disk.flatness(),
                            .least_cosine = disk.least_cosine(),
                            .most_before = in_.maximum_events - walk_.events(),
                            .edges = weights.bounds.edges,
                            .slope = weights.wide.slope,
                            .narrow_slope = weights.narrow.slope,
                            .weights = in_.weights.matt_vertex(
                                vertices_.list(), vertices_.plan().counted_area(in_.camera_samples),
                                vertices_.plan().counted_survival(0)),
                            .only_after_specular = is_only_focused_wanted()},
                           each);
  const Spectrum reflected = vertex.diffuse_value();
  MergedLight result;
  const auto add = [&](Component component, const MattLight::Sum& sum) {
    if (!walk_.wants(component)) return;
    result.of[size_t(component)] += sum.wide * reflected;
    result.narrow += sum.narrow * reflected;
  };
  add(walk_.component_of(Lobes::diffuse, true), light.after_specular);
  add(walk_.component_of(Lobes::diffuse, false), light.other);
  return result;
}

SurfaceMerging::Part SurfaceMerging::part_of(size_t vertices, uint32_t most_parts) const {
  const size_t parts = std::clamp(vertices / least_in_part, size_t(1), size_t(most_parts));
  if (parts == 1) return {0, 1};
  const float u = walk_.sampler().fork(Fork::merge_part).next_1d();
  return {std::min(size_t(u * float(parts)), parts - 1), parts};
}

template <typename Visit>
void SurfaceMerging::visit_at_gauge(float radius, uint32_t most_parts, const Visit& visit) const {
  const SurfaceVertex& vertex = walk_.vertex();
  const std::span<const GaugeVertex> all = in_.light.at_gauges.of(size_t(walk_.gauge()));
  const Part part = part_of(all.size(), most_parts);
  PathHalves path = vertices_.halves();
  for (size_t i = part.first; i < all.size(); i += part.step) {
    const GaugeVertex& at = all[i];
    if (!(at.offset_sq < sqr(radius))) continue;
    if (walk_.events() + int(at.data.before) > in_.maximum_events) continue;
    const BsdfValues bsdf = vertex.values(at.data.direction.unpack());
    path.light = in_.light.before(at.data);
    path.first_survival = vertices_.counted_survival_toward(bsdf);
    path.pdf_light_last = at.pdf_light;
    path.pdf_camera_last = bsdf.pdf * at.to_previous;
    path.pdf_camera_before_last = path.light[path.light.size() - 2].pdf_camera;
    path.pdf_next_event = at.data.pdf_next_event;
    visit(at, at.data.flux.spectrum() * float(part.step), bsdf, path);
  }
}

size_t SurfaceMerging::find_near(const MergeDisk& disk, uint32_t most_parts,
                                 std::vector<Near>& near) const {
  const SurfaceVertex& vertex = walk_.vertex();
  const bool both_sides = disk.both_sides();
  const Vec3f& ng = vertex.point().ng;
  const Vec3f side = both_sides || vertex.on_front() ? ng : -ng;
  const auto& tree = in_.light.tree.tree();
  const auto list = scratch_.list<uint32_t>();
  std::vector<uint32_t>& numbers = *list;
  in_.light.tree.within(vertex.position(), side, both_sides, sqr(disk.radius()),
                        [&](uint32_t number, float) { numbers.push_back(number); });
  // Neighbours in the tree are neighbours in the disk: one in so many is spread over it.
  const auto [first, parts] = part_of(numbers.size(), most_parts);
  for (size_t i = first; i < numbers.size(); i += parts) {
    const LightVertexData& photon = tree.data(numbers[i]);
    const Vec3f offset = tree.key(numbers[i]) - vertex.position();
    const float cover = disk.share(offset, photon.side);
    if (cover > 0 && walk_.events() + int(photon.before) <= in_.maximum_events)
      near.push_back({numbers[i], cover, offset});
  }
  return parts;
}

template <typename Visit>
void SurfaceMerging::visit_merging(const MergeDisk& disk, uint32_t most_parts,
                                   const Visit& visit) const {
  const auto near_list = scratch_.list<Near>();
  const auto directions = scratch_.list<Vec3f>();
  const auto values = scratch_.list<BsdfValues>();
  const size_t parts = find_near(disk, most_parts, *near_list);
  const auto& tree = in_.light.tree.tree();
  for (const Near& near : *near_list)
    directions->push_back(tree.data(near.number).direction.unpack());
  walk_.vertex().values(*directions, *values);
  // Paths lie anywhere in memory: waiting for one after the other took half the time.
  if (!in_.tails)
    for (const Near& near : *near_list) {
      const LightVertexData& photon = tree.data(near.number);
      prefetch(in_.light.vertices.data() + photon.path);
      prefetch(&in_.light.at(photon));
    }
  PathHalves path = vertices_.halves();
  for (size_t i = 0; i < near_list->size(); ++i) {
    const Near& near = (*near_list)[i];
    const LightVertexData& photon = tree.data(near.number);
    const Vec3f& wi = (*directions)[i];
    const BsdfValues& bsdf = (*values)[i];
    path.light = in_.light.before(photon);
    path.pdf_light_before_last = vertices_.pdf_light_before(wi, bsdf.pdf_reverse);
    path.first_survival = vertices_.counted_survival_toward(bsdf);
    if (in_.tails) {
      const PathWeights::LightTail& tail = (*in_.tails)[near.number];
      path.pdf_light_last = tail.pdf_light;
      path.pdf_camera_last = bsdf.pdf * tail.to_previous;
    } else {
      const PathVertex& merged = in_.light.at(photon);
      path.pdf_light_last = merged.pdf_light;
      path.pdf_camera_last = bsdf.pdf * merged.to_previous;
      path.pdf_camera_before_last = path.light[path.light.size() - 2].pdf_camera;
      path.pdf_next_event = photon.pdf_next_event;
    }
    visit(near, photon, photon.flux.spectrum() * (near.cover * float(parts)), wi, bsdf, path);
  }
}

float SurfaceMerging::weight_of(const Near& near, const PathHalves& path) const {
  if (!in_.tails) return in_.weights.merge(path);
  return in_.weights.merge(path, (*in_.tails)[near.number], in_.tails->merges(near.number));
}

SurfaceMerging::MergedLight SurfaceMerging::merged(const MergeDisk& disk,
                                                   const DiskWeights& weights, Lobes lobes,
                                                   std::vector<MergedPart>* each) const {
  const SurfaceVertex& vertex = walk_.vertex();
  const float radius_sq = sqr(disk.radius());
  MergedLight result;
  // Farther on every sample is somewhere else.
  const uint32_t most_parts =
      vertices_.is_at_first() ? uint32_t(std::max(1.0f, in_.camera_samples)) : 1;
  visit_merging(disk, most_parts,
                [&](const Near& near, const LightVertexData& photon, const Spectrum& flux,
                    const Vec3f& wi, const BsdfValues& bsdf, const PathHalves& path) {
                  const Vec3f& offset = near.offset;
                  if (!weights.bounds.edges.hold(offset)) return;
                  const float weight = weight_of(near, path);
                  if (!(weight > 0)) return;
                  const Spectrum arriving =
                      flux * (vertex.has_relief() ? weight * vertex.irradiance_factor(wi) : weight);
                  const float share = length_sq(offset) / radius_sq;
                  const float kernel = (1 - share) * weights.wide.factor(offset);
                  const float narrow_kernel = std::max(0.0f, 1 - share / sqr(narrow_radius)) *
                                              weights.narrow.factor(offset);
                  for (const Lobes lobe : {Lobes::diffuse, Lobes::glossy}) {
                    if (!any(lobes & lobe)) continue;
                    const Component component = walk_.component_of(lobe, photon.specular);
                    if (!walk_.wants(component)) continue;
                    const Spectrum reflected = arriving * bsdf.of(lobe);
                    result.of[size_t(component)] += reflected * kernel;
                    result.narrow += reflected * narrow_kernel;
                    if (each) each->push_back({offset, component, reflected * kernel});
                  }
                });
  return result;
}

std::vector<SurfaceMerging::MergedVertex> SurfaceMerging::merged_vertices() const {
  const SurfaceVertex& vertex = walk_.vertex();
  const float radius = vertices_.merge_radius();
  std::vector<MergedVertex> result;
  if (!(radius > 0)) return result;
  if (walk_.gauge() >= 0) {
    visit_at_gauge(radius, 1,
                   [&](const GaugeVertex& at, const Spectrum& flux, const BsdfValues& bsdf,
                       const PathHalves& path) {
                     if (!walk_.wants(walk_.component_of(Lobes::diffuse, at.data.specular))) return;
                     const float kernel = 2 * (1 - at.offset_sq / sqr(radius)) /
                                          (pi * sqr(radius) * float(in_.light.path_count));
                     const Spectrum light =
                         walk_.throughput() * bsdf.of(Lobes::diffuse) * flux * kernel;
                     result.push_back({in_.weights.beyond_merge(path), light,
                                       at.data.specular ? Spectrum() : light, bsdf.glossy_share()});
                   });
    return result;
  }
  const MergeDisk disk(vertex, radius);
  visit_merging(disk, 1,
                [&](const Near& near, const LightVertexData& photon, const Spectrum& flux,
                    const Vec3f& wi, const BsdfValues& bsdf, const PathHalves& path) {
                  const float distance_sq = length_sq(near.offset);
                  const float kernel = 2 * (1 - distance_sq / sqr(radius)) /
                                       (pi * sqr(radius) * float(in_.light.path_count));
                  const float factor =
                      vertex.has_relief() ? kernel * vertex.irradiance_factor(wi) : kernel;
                  Spectrum reflected, indirect;
                  for (const Lobes lobe : {Lobes::diffuse, Lobes::glossy}) {
                    const Component component = walk_.component_of(lobe, photon.specular);
                    if (!any(vertex.lobes() & lobe) || !walk_.wants(component)) continue;
                    reflected += bsdf.of(lobe);
                    if (component == Component::indirect) indirect += bsdf.of(lobe);
                  }
                  const Spectrum arriving = walk_.throughput() * flux * factor;
                  result.push_back({in_.weights.beyond_merge(path), arriving * reflected,
                                    arriving * indirect, bsdf.glossy_share()});
                });
  return result;
}

}  // namespace kaustik
