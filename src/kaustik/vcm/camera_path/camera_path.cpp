#include "kaustik/vcm/camera_path/camera_path.h"

#include <algorithm>

#include "kaustik/base/prefetch.h"
#include "kaustik/photon/coverage/merge_disk.h"
#include "kaustik/photon/volume_sight.h"
#include "kaustik/transport/visibility.h"

namespace kaustik {
namespace {

/// One walk after the other, but for branches, so each thread has one list.
std::vector<PathVertex>& empty_list() {
  static thread_local std::vector<PathVertex> list;
  list.clear();
  return list;
}

/// Where many light vertices merge one by one, the samples of a pixel share them out, in parts that
/// are no smaller: all samples merge with the same vertices, and a part costs about as much as the
/// way there.
constexpr size_t least_in_part = 64;

std::vector<uint32_t>& empty_indices() {
  static thread_local std::vector<uint32_t> indices;
  indices.clear();
  return indices;
}

/// Of the sampler's forks for the coverage of the disk of merging, for the bias of merging (two),
/// for the part of what merges, and for that which tells what is reached.
constexpr uint32_t coverage_key = 1, bias_key = 2, part_key = 4, reached_key = 5,
                   reached_in_medium_key = 6;

std::vector<MattMerging::Factors>& empty_factors() {
  static thread_local std::vector<MattMerging::Factors> factors;
  factors.clear();
  return factors;
}

/// Chance with which that is estimated: it takes rays.
constexpr float bias_chance = 0.25f;

/// A point of `light` as emission sees it: its normal is on the side that shines to `direction`.
SurfacePoint shining(const Light& light, SurfacePoint point, const Vec3f& direction) {
  if (light.is_two_sided() && dot(point.ng, direction) < 0) {
    point.ng = -point.ng;
    point.ns = -point.ns;
  }
  return point;
}

}  // namespace

VcmCameraPath::VcmCameraPath(const VcmCameraInputs& inputs, CameraWalk& walk, const PixelPlan& plan)
    : in_(inputs), walk_(walk), plan_(plan), vertices_(empty_list()), vertices_before_(0) {
  walk.weigh_by(*this);
}

VcmCameraPath::VcmCameraPath(const VcmCameraPath& other, CameraWalk& branch)
    : in_(other.in_),
      walk_(branch),
      plan_(other.plan_),
      vertices_(other.vertices_),
      vertices_before_(vertices_.size()),
      back_(other.back_),
      here_(branch.scatterer()),
      last_(other.last_),
      last_facing_(other.last_facing_),
      previous_(other.previous_),
      all_delta_(other.all_delta_),
      no_light_paths_(other.no_light_paths_),
      first_(other.first_) {
  walk_.weigh_by(*this);
}

PathVertex VcmCameraPath::next_vertex(const Vec3f& position, const Facing& facing) const {
  PathVertex next;
  if (facing.extinction > 0) next.mean_free_path = 1 / facing.extinction;
  if (vertices_.empty()) {
    const CameraConnection connection = in_.scene.camera().connect(position);
    next.pdf_camera = connection.importance * in_.camera_samples *
                      facing.factor(connection.direction) / sqr(connection.distance);
    return next;
  }
  const PathVertex& before = vertices_.back();
  const float pdf = before.delta ? 1.0f : walk_.last_pdf();
  const Vec3f& direction = walk_.ray().direction;
  const float distance_sq = length_sq(position - last_.position);
  next.pdf_camera = pdf * facing.factor(direction) / distance_sq;
  next.to_previous = last_facing_.factor(direction) / distance_sq;
  next.spread = in_.weights.spread_after(before.spread, next.pdf_camera, next, before.delta);
  return next;
}

PathVertex VcmCameraPath::next_in_medium(const Vec3f& position, const Medium& medium) const {
  PathVertex next = next_vertex(position, {{}, mean_extinction(medium)});
  next.merge_volume = in_.media.merge_volume(position, medium);
  return next;
}

PathVertex VcmCameraPath::infinitely_far() const {
  PathVertex next;
  const PathVertex& before = vertices_.back();
  next.pdf_camera = before.delta ? 1.0f : walk_.last_pdf();
  next.spread = in_.weights.spread_after(before.spread, next.pdf_camera, next, before.delta);
  return next;
}

CameraWalk::Arrival VcmCameraPath::go_on(bool scatters_in_media) {
  const bool had_roulette = has_roulette_at_first();
  CameraWalk::Arrival arrival = CameraWalk::Arrival::nothing;
  if (scatters_in_media)
    arrival = walk_.fly(in_.weights.settings().techniques.merging ? this : nullptr);
  else if (walk_.advance())
    arrival = CameraWalk::Arrival::surface;
  if (arrival == CameraWalk::Arrival::nothing) return arrival;
  if (had_roulette) walk_.has_survived(plan_.survival);
  arrive();
  return arrival;
}

void VcmCameraPath::arrive() {
  here_ = walk_.scatterer();
  const SurfacePoint& point = here_.point();
  const Facing facing = here_.facing();
  vertices_.push_back(here_.is_in_medium() ? next_in_medium(point.position, *walk_.medium())
                                           : next_vertex(point.position, facing));
  last_ = point;
  last_facing_ = facing;
  find_guides();
}

void VcmCameraPath::find_guides() {
  back_ = {};
  // What goes back along delta events alone nothing else finds.
  if (!in_.scattering || all_delta_ || here_.is_in_medium()) return;
  if (!in_.weights.settings().techniques.needs_light_paths()) return;
  const SurfaceVertex& vertex = *here_.surface();
  const Vec3f& ng = vertex.point().ng;
  for (const bool front : {false, true}) {
    if (front != vertex.on_front() && !vertex.transmits()) continue;
    const ScatterGuide::Place place = in_.scattering->place(vertex, front ? ng : -ng);
    back_[front ? 1 : 0] = {1 - place.guided(), place.pdf(0, here_.wo())};
  }
}

void VcmCameraPath::leave() {
  PathVertex& vertex = vertices_.back();
  vertex.delta = walk_.last_pdf() == 0;
  if (!vertex.delta && all_delta_) {
    all_delta_ = false;
    first_ = vertices_.size();
  }
  previous_ = here_.is_in_medium() ? LightQuery(here_.position()) : light_query(walk_.vertex());
  if (vertices_.size() < 2 || !in_.weights.settings().techniques.needs_light_paths()) return;
  vertices_[vertices_.size() - 2].pdf_light =
      vertex.delta ? vertex.to_previous : pdf_light_before(walk_.ray().direction);
}

bool VcmCameraPath::path_tracing_alone(size_t length) const {
  const Techniques& techniques = in_.weights.settings().techniques;
  if (no_light_paths_ || !techniques.needs_light_paths()) return true;
  return length <= 2 && !(techniques.merging && is_in_medium());
}

PathHalves VcmCameraPath::halves() const {
  PathHalves result;
  result.camera = vertices_;
  result.first_merge_area = plan_.counted_area(in_.camera_samples);
  result.first_survival = plan_.counted_survival();
  result.connected = plan_.connected;
  return result;
}

float VcmCameraPath::pdf_light_before(const Vec3f& wi) const {
  if (vertices_.size() < 2) return 0;
  return pdf_light_before(wi, here_.pdf_reverse(wi, Lobes::all));
}

float VcmCameraPath::pdf_light_before(const Vec3f& wi, float pdf_reverse) const {
  if (vertices_.size() < 2) return 0;
  const GuidedBack& back = back_[dot(wi, last_.ng) >= 0 ? 1 : 0];
  return (back.unguided * pdf_reverse + back.guided) * vertices_.back().to_previous;
}

float VcmCameraPath::sampled(const Scatterer& vertex, const DirectLight& light) const {
  const Techniques& techniques = in_.weights.settings().techniques;
  if (!techniques.next_event) return 0;
  const bool is_alone = path_tracing_alone(vertices_.size() + 1);
  if (is_alone) {
    if (light.pdf_solid_angle == 0 || !techniques.unidirectional) return 1;
    return mis_weight(light.pdf_solid_angle, vertex.pdf(light.wi, Lobes::all));
  }
  const Light& of = *in_.scene.lights()[size_t(light.light)];
  const SurfacePoint origin = shining(of, light.on_light, -light.wi);
  const EmissionDensity emission =
      in_.emission.pdf(light.light, of.is_infinite() ? vertex.point() : origin, -light.wi);
  const float cosine = vertex.facing().factor(light.wi);
  const float distance_sq = of.is_infinite() ? 1.0f : sqr(light.distance);
  const float light_cosine =
      of.is_infinite() || of.is_delta() ? 1.0f : abs_dot(light.wi, of.emitting_normal(origin));
  const float to_area = of.is_delta() ? 1.0f : light_cosine / distance_sq;
  PathVertex on_light;
  on_light.pdf_light = emission.endpoint > 0 ? emission.endpoint : 1.0f;
  PathHalves path = halves();
  path.light = {&on_light, 1};
  path.pdf_light_last = emission.rest * cosine / distance_sq;
  path.pdf_light_before_last = pdf_light_before(light.wi);
  path.pdf_camera_last =
      light.pdf_solid_angle == 0 ? 0.0f : vertex.pdf(light.wi, Lobes::all) * to_area;
  path.pdf_next_event = light.pdf_sampled * to_area;
  return in_.weights.next_event(path);
}

float VcmCameraPath::met(int light, const SurfaceVertex& vertex) const {
  const Techniques& techniques = in_.weights.settings().techniques;
  if (!techniques.unidirectional) return vertices_.empty() ? 1.0f : 0.0f;
  if (vertices_.empty()) return 1;
  const SurfacePoint& point = vertex.point();
  const bool after_delta = vertices_.back().delta;
  const float next_event =
      after_delta || !techniques.next_event
          ? 0.0f
          : direct_light_pdf(in_.scene, weighed_query(), LightChoice::one, light, point);
  if (path_tracing_alone(vertices_.size() + 1))
    return next_event > 0 ? mis_weight(walk_.last_pdf(), next_event) : 1.0f;
  const Vec3f direction = -vertex.wo();
  const float distance_sq = length_sq(point.position - last_.position);
  const SurfacePoint origin = shining(*in_.scene.lights()[size_t(light)], point, vertex.wo());
  const EmissionDensity emission = in_.emission.pdf(light, origin, vertex.wo());
  const PathVertex on_light = next_vertex(point.position, {point.ng, 0});
  return met_weight(on_light, emission, last_facing_.factor(direction) / distance_sq,
                    next_event * abs_dot(direction, point.ng) / distance_sq);
}

float VcmCameraPath::met(int light, const Ray& ray) const {
  const Techniques& techniques = in_.weights.settings().techniques;
  if (!techniques.unidirectional) return vertices_.empty() ? 1.0f : 0.0f;
  if (vertices_.empty()) return 1;
  const float next_event =
      vertices_.back().delta || !techniques.next_event
          ? 0.0f
          : direct_light_pdf(in_.scene, weighed_query(), LightChoice::one, light, ray.direction);
  if (path_tracing_alone(vertices_.size() + 1))
    return next_event > 0 ? mis_weight(walk_.last_pdf(), next_event) : 1.0f;
  const EmissionDensity emission = in_.emission.pdf(light, last_, -ray.direction);
  return met_weight(infinitely_far(), emission, last_facing_.factor(ray.direction), next_event);
}

float VcmCameraPath::met_weight(const PathVertex& on_light, const EmissionDensity& emission,
                                float to_last, float next_event) const {
  vertices_.push_back(on_light);
  PathHalves path = halves();
  path.pdf_light_last = emission.endpoint > 0 ? emission.endpoint : 1.0f;
  path.pdf_light_before_last = emission.rest * to_last;
  path.pdf_next_event = next_event;
  const float weight = in_.weights.unidirectional(path);
  vertices_.pop_back();
  return weight;
}

void VcmCameraPath::connect(int count) {
  const std::vector<ConnectibleVertex>& all = in_.light.connectible;
  if (all.empty() || !(plan_.connected > 0) ||
      !any(here_.lobes() & (Lobes::diffuse | Lobes::glossy)))
    return;
  for (int i = 0; i < count; ++i) {
    // One number alone has too few bits for millions of vertices.
    const Vec2f u = walk_.sampler().one_of(uint32_t(count), uint32_t(i)).next_2d();
    const double which = (double(u.x) + double(u.y) * 0x1p-24) * double(all.size());
    connect_to(all[std::min(size_t(which), all.size() - 1)]);
  }
}

float VcmCameraPath::pdf_of_light(const Scatterer& at, const Vec3f& to) const {
  const float plain = at.pdf(to, Lobes::all);
  if (!in_.scattering || at.is_in_medium()) return plain;
  return in_.scattering->place(*at.surface(), at.wo()).pdf(plain, to);
}

void VcmCameraPath::connect_to(const ConnectibleVertex& to) {
  // Events: those of the walk, at both vertices, and between the light and `to`.
  if (walk_.events() + 1 + int(to.data.before) > in_.maximum_events) return;
  const Scatterer& vertex = here_;
  SurfaceVertex surface;
  if (!to.in_medium) surface.meet(in_.scene, to.ray, to.hit, TransportMode::flux);
  const Scatterer other =
      to.in_medium ? Scatterer(to.ray.origin, -to.ray.direction, *to.medium) : Scatterer(surface);
  const Vec3f between = other.position() - vertex.position();
  const float distance_sq = length_sq(between);
  if (!(distance_sq > 0)) return;
  const Vec3f direction = between * (1 / std::sqrt(distance_sq));
  const PathVertex& other_data = in_.light.at(to.data);
  PathHalves path = halves();
  path.light = {in_.light.vertices.data() + to.data.path, size_t(to.data.before) + 1};
  path.pdf_light_last =
      pdf_of_light(other, -direction) * vertex.facing().factor(direction) / distance_sq;
  path.pdf_light_before_last = pdf_light_before(direction);
  path.pdf_camera_last =
      vertex.pdf(direction, Lobes::all) * other.facing().factor(direction) / distance_sq;
  path.pdf_camera_before_last = other.pdf_reverse(-direction, Lobes::all) * other_data.to_previous;
  path.pdf_next_event = to.data.pdf_next_event;
  const float weight = in_.weights.connection(path);
  if (!(weight > 0)) return;
  const Spectrum arriving = to.data.flux_spectrum() * (weight * in_.connection_scale / distance_sq);
  Spectrum visible;
  bool traced = false;
  for (const Lobes lobe : {Lobes::diffuse, Lobes::glossy}) {
    if (!any(vertex.lobes() & lobe)) continue;
    const Spectrum reflected = vertex.eval_cosine(direction, lobe);
    if (reflected.is_zero()) continue;
    for (const Lobes other_lobe : {Lobes::diffuse, Lobes::glossy}) {
      if (!any(other.lobes() & other_lobe)) continue;
      const Component component =
          vertex.is_in_medium()
              ? walk_.component_in_medium()
              : walk_.component_of(lobe, other_lobe == Lobes::glossy && to.data.specular);
      if (!walk_.wants(component)) continue;
      const Spectrum value = reflected * arriving * other.eval_cosine(-direction, other_lobe);
      if (value.is_zero()) continue;
      if (!traced) {
        traced = true;
        visible =
            shadow_ray_transmittance(in_.scene, spawn_ray_to(vertex.point(), other.point()),
                                     vertex.medium_toward(direction, walk_.medium()), walk_.rays());
        if (visible.is_zero()) return;
      }
      walk_.add(component, value * visible);
    }
  }
}

void VcmCameraPath::merge() {
  const SurfaceVertex& vertex = walk_.vertex();
  const Lobes lobes = vertex.lobes() & (Lobes::diffuse | Lobes::glossy);
  if (!any(lobes) || in_.light.tree.empty() || !in_.weights.merges_at(vertices_)) return;
  const auto wanted = [&](Lobes lobe) {
    return any(lobes & lobe) && (walk_.wants(walk_.component_of(lobe, true)) ||
                                 walk_.wants(walk_.component_of(lobe, false)));
  };
  if (!wanted(Lobes::diffuse) && !wanted(Lobes::glossy)) return;
  const float widest = merge_radius();
  if (!(widest > 0)) return;
  const DiskCoverage covered(in_.scene, MergeDisk(vertex, widest), walk_.rays(),
                             disk_bounds(widest).clear_flatness);
  const float radius = std::min(widest, std::max(covered.clear_radius(), walk_.footprint().width));
  const DiskBounds bounds = disk_bounds(radius);
  const MergeDisk disk = bounds.are_clear() ? MergeDisk(vertex, radius, bounds.clear_flatness)
                                            : MergeDisk(vertex, radius);
  const DiskWeights weights = disk_weights(disk, bounds);
  const bool is_matt =
      all_delta_ && lobes == Lobes::diffuse && !vertex.transmits() && !vertex.has_relief();
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
      covered.inverse_share(radius, weights.bounds.edges, walk_.sampler().fork(coverage_key)) /
      paths);
  Spectrum total;
  for (int c = 0; c < component_count; ++c) {
    const Spectrum& sum = light.of[size_t(c)];
    if (!sum.is_zero()) walk_.add(Component(c), sum);
    total += sum;
  }
  // The bias is estimated as if it grew by the radius, as it does where light has an edge: where it
  // is smooth it grows by the area, and is two thirds of that.
  if (!(walk_.sampler().fork(bias_key).next_1d() < bias_chance)) return;
  const float narrow_coverage = covered.inverse_share(radius * narrow_radius, weights.bounds.edges,
                                                      walk_.sampler().fork(bias_key + 1));
  const Spectrum narrow = light.narrow * (weights.narrow.scale * narrow_coverage / paths);
  walk_.add_bias((total - narrow) * (1 / ((1 - narrow_radius) * bias_chance)));
}

std::vector<VcmCameraPath::MergedPart>& VcmCameraPath::empty_parts() {
  static thread_local std::vector<MergedPart> parts;
  parts.clear();
  return parts;
}

bool VcmCameraPath::MergedLight::is_zero() const {
  return std::all_of(of.begin(), of.end(), [](const Spectrum& sum) { return sum.is_zero(); });
}

VcmCameraPath::Draws VcmCameraPath::draws_of(const MergedLight& light) const {
  const float u = walk_.sampler().fork(reached_key).next_1d();
  Draws draws;
  for (size_t c = 0; c < draws.size(); ++c)
    if (!light.of[c].is_zero()) draws[c].emplace(light.of[c], u);
  return draws;
}

template <typename IsReached>
void VcmCameraPath::leave_drawn(const Draws& draws, const IsReached& is_reached,
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

VcmCameraPath::MergedLight VcmCameraPath::reached_matt(const MergeDisk& disk,
                                                       const DiskWeights& weights,
                                                       const DiskCoverage& covered) const {
  std::vector<MattMerging::Factors>& each = empty_factors();
  MergedLight light = merged_matt(disk, weights, &each);
  if (light.is_zero()) return light;
  const SurfaceVertex& vertex = walk_.vertex();
  const Spectrum reflected = vertex.diffuse_value();
  Draws draws = draws_of(light);
  for (const auto kind : {MattMerging::other, MattMerging::after_specular}) {
    const bool specular = kind == MattMerging::after_specular;
    if (auto& draw = draws[size_t(walk_.component_of(Lobes::diffuse, specular))])
      in_.matt.offer(each, kind, reflected, *draw);
  }
  leave_drawn(
      draws,
      [&](size_t number) {
        return covered.reaches(disk.radius(),
                               in_.matt.position(uint32_t(number)) - vertex.position());
      },
      light);
  return light;
}

VcmCameraPath::MergedLight VcmCameraPath::reached(const MergeDisk& disk, const DiskWeights& weights,
                                                  Lobes lobes, const DiskCoverage& covered) const {
  std::vector<MergedPart>& each = empty_parts();
  MergedLight light = merged(disk, weights, lobes, &each);
  if (light.is_zero()) return light;
  Draws draws = draws_of(light);
  for (size_t i = 0; i < each.size(); ++i)
    if (auto& draw = draws[size_t(each[i].component)]) draw->offer(i, each[i].light);
  leave_drawn(
      draws, [&](size_t i) { return covered.reaches(disk.radius(), each[i].offset); }, light);
  return light;
}

void VcmCameraPath::MergedLight::scale(float factor) {
  for (Spectrum& sum : of) sum *= factor;
}

DiskBounds VcmCameraPath::disk_bounds(float radius) const {
  if (!all_delta_) return {};
  return in_.pixels.seen().disk_bounds(walk_.raster(), walk_.vertex(), radius);
}

VcmCameraPath::DiskWeights VcmCameraPath::disk_weights(const MergeDisk& disk,
                                                       const DiskBounds& bounds) const {
  const DiskEdges& edges = bounds.edges;
  const Frame frame(disk.side());
  DiskWeights weights{
      bounds, DiskKernel(frame, disk.radius(), edges, KernelShape::parabolic),
      DiskKernel(frame, disk.radius() * narrow_radius, edges, KernelShape::parabolic)};
  // Slopes are for all of what edges leave, not for a part of it that is covered.
  if (!bounds.are_complete || !(bounds.are_clear() || !in_.visibility)) {
    weights.wide.level();
    weights.narrow.level();
  }
  return weights;
}

VcmCameraPath::MergedLight VcmCameraPath::merged_matt(
    const MergeDisk& disk, const DiskWeights& weights,
    std::vector<MattMerging::Factors>* each) const {
  const SurfaceVertex& vertex = walk_.vertex();
  const MattLight light =
      in_.matt.merge({vertex.position(), disk.side(), disk.radius(), disk.flatness(),
                      disk.least_cosine(), in_.maximum_events - walk_.events(),
                      weights.bounds.edges, weights.wide.slope, weights.narrow.slope,
                      in_.weights.matt_vertex(vertices_, plan_.counted_area(in_.camera_samples),
                                              plan_.counted_survival(), plan_.connected)},
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

float VcmCameraPath::merge_radius() const {
  return std::sqrt(all_delta_ ? plan_.merge_area * inv_pi : in_.merge_radius_sq);
}

template <typename Visit>
void VcmCameraPath::visit_merging(const MergeDisk& disk, uint32_t most_parts,
                                  const Visit& visit) const {
  const SurfaceVertex& vertex = walk_.vertex();
  const bool both_sides = disk.both_sides();
  const Vec3f& ng = vertex.point().ng;
  const Vec3f side = both_sides || vertex.on_front() ? ng : -ng;
  const auto& tree = in_.light.tree.tree();
  std::vector<uint32_t>& near = empty_indices();
  in_.light.tree.within(vertex.position(), side, both_sides, sqr(disk.radius()),
                        [&](uint32_t index, float) { near.push_back(index); });
  // Neighbours in the tree are neighbours in the disk: one in so many is spread over it.
  const size_t parts = std::clamp(near.size() / least_in_part, size_t(1), size_t(most_parts));
  size_t first = 0;
  if (parts > 1)
    first = std::min(size_t(walk_.sampler().fork(part_key).next_1d() * float(parts)), parts - 1);
  // Paths lie anywhere in memory: waiting for one after the other took half the time.
  for (size_t i = first; i < near.size(); i += parts) {
    const LightVertexData& photon = tree.data(near[i]);
    const PathVertex* before = in_.light.vertices.data() + photon.path;
    prefetch(before);
    prefetch(before + photon.before);
  }
  PathHalves path = halves();
  for (size_t i = first; i < near.size(); i += parts) {
    const uint32_t index = near[i];
    const LightVertexData& photon = tree.data(index);
    const Vec3f offset = tree.key(index) - vertex.position();
    const float cover = disk.share(offset, photon.side);
    if (!(cover > 0)) continue;
    if (walk_.events() + int(photon.before) > in_.maximum_events) continue;
    const Vec3f wi = photon.direction.unpack();
    const BsdfValues bsdf = vertex.values(wi);
    const PathVertex* before = in_.light.vertices.data() + photon.path;
    const PathVertex& merged = before[photon.before];
    path.light = {before, photon.before};
    path.pdf_light_last = merged.pdf_light;
    path.pdf_light_before_last = pdf_light_before(wi, bsdf.pdf_reverse);
    path.pdf_camera_last = bsdf.pdf * merged.to_previous;
    path.pdf_camera_before_last = before[photon.before - 2].pdf_camera;
    path.pdf_next_event = photon.pdf_next_event;
    visit(photon, photon.flux_spectrum() * (cover * float(parts)), offset, wi, bsdf, path);
  }
}

VcmCameraPath::MergedLight VcmCameraPath::merged(const MergeDisk& disk, const DiskWeights& weights,
                                                 Lobes lobes, std::vector<MergedPart>* each) const {
  const SurfaceVertex& vertex = walk_.vertex();
  const float radius_sq = sqr(disk.radius());
  MergedLight result;
  // Farther on every sample is somewhere else.
  const uint32_t most_parts = all_delta_ ? uint32_t(std::max(1.0f, in_.camera_samples)) : 1;
  visit_merging(disk, most_parts,
                [&](const LightVertexData& photon, const Spectrum& flux, const Vec3f& offset,
                    const Vec3f& wi, const BsdfValues& bsdf, const PathHalves& path) {
                  if (!weights.bounds.edges.hold(offset)) return;
                  const float weight = in_.weights.merge(path);
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

std::vector<VcmCameraPath::MergedVertex> VcmCameraPath::merged_vertices() const {
  const SurfaceVertex& vertex = walk_.vertex();
  const float radius = merge_radius();
  std::vector<MergedVertex> result;
  if (!(radius > 0)) return result;
  const MergeDisk disk(vertex, radius);
  visit_merging(
      disk, 1,
      [&](const LightVertexData& photon, const Spectrum& flux, const Vec3f& offset, const Vec3f& wi,
          const BsdfValues& bsdf, const PathHalves& path) {
        const float distance_sq = length_sq(offset);
        const float kernel =
            2 * (1 - distance_sq / sqr(radius)) / (pi * sqr(radius) * float(in_.light.path_count));
        const float factor = vertex.has_relief() ? kernel * vertex.irradiance_factor(wi) : kernel;
        Spectrum reflected;
        for (const Lobes lobe : {Lobes::diffuse, Lobes::glossy})
          if (any(vertex.lobes() & lobe) && walk_.wants(walk_.component_of(lobe, photon.specular)))
            reflected += bsdf.of(lobe);
        result.push_back(
            {in_.weights.beyond_merge(path), walk_.throughput() * reflected * flux * factor});
      });
  return result;
}

float VcmCameraPath::merging_length() const {
  const PathWeights::Settings& settings = in_.weights.settings();
  if (!settings.techniques.merging) return 0;
  if (all_delta_) return infinity;
  const float spread = vertices_.back().spread;
  if (vertices_.back().delta) return spread >= settings.least_spread ? infinity : 0.0f;
  if (!(settings.least_spread > 0)) return infinity;
  // Across the segment its density is pdf / length².
  if (spread < settings.least_spread) return 0;
  return std::sqrt(spread * walk_.last_pdf() * settings.accepted_area / settings.least_spread);
}

float VcmCameraPath::medium_merge_weight(const MergeableMediumVertex& light, float phase,
                                         float phase_back) const {
  const PathVertex& at = vertices_.back();
  const PathVertex* before = in_.light.vertices.data() + light.path;
  PathHalves path = halves();
  path.light = {before, light.before};
  path.pdf_light_last = light.pdf_light;
  path.pdf_light_before_last = phase_back * at.to_previous;
  path.pdf_camera_last = phase * light.to_previous;
  if (light.before >= 2) path.pdf_camera_before_last = before[light.before - 2].pdf_camera;
  path.pdf_next_event = light.pdf_next_event;
  return in_.weights.merge(path);
}

Spectrum VcmCameraPath::radiance(const Ray& ray, float length, const Medium& medium,
                                 const Sampler& sampler, uint64_t& rays) const {
  Spectrum sum;
  const float merging = std::min(length, merging_length());
  if (in_.light.in_media.empty() || !(merging > 0)) return sum;
  const PhaseFunction& phase_function = medium.phase();
  const Vec3f wo = -ray.direction;
  const auto count = float(in_.light.path_count);
  std::vector<VolumePart>& parts = empty_volume_parts();
  in_.light.in_media.discs.visit_met(ray, merging, [&](size_t i, float along, float distance_sq) {
    const MergeableMediumVertex& light = in_.light.in_media.data[i];
    if (!light.medium->is_like(medium) || walk_.events() + int(light.before) > in_.maximum_events)
      return;
    const Vec3f position = ray.origin + ray.direction * along;
    const float radius_sq = sqr(in_.light.in_media.discs.radius(i));
    const Vec3f wi = light.direction.unpack();
    const float phase = phase_function.eval(wo, wi);
    vertices_.push_back(next_in_medium(position, medium));
    const float weight = medium_merge_weight(light, phase, phase_function.eval(wi, wo));
    vertices_.pop_back();
    const float kernel = 2 * inv_pi * (1 - distance_sq / radius_sq) / radius_sq;
    parts.push_back(
        {i, position,
         light.flux_spectrum() * medium.transmittance(along) * (kernel * phase * weight / count)});
    sum += parts.back().light;
  });
  if (!in_.visibility || sum.is_zero()) return sum;
  return visible_from_segment(in_.scene, in_.light.in_media.discs, parts, sum,
                              sampler.fork(reached_in_medium_key).next_1d(), rays);
}

bool VcmCameraPath::survives_first(float u) {
  if (!has_roulette_at_first() || u < plan_.survival) return true;
  walk_.meet_lamps_only();
  return may_end_at_lamp();
}

}  // namespace kaustik
