#include "kaustik/vcm/gathering/gathered_light.h"

#include <cmath>

#include "kaustik/photon/coverage/merge_disk.h"
#include "kaustik/photon/lane_draw.h"
#include "kaustik/transport/direct_light.h"
#include "kaustik/transport/roulette.h"
#include "kaustik/transport/travel.h"

namespace kaustik {
namespace {

/// Events of a gather ray before roulette.
constexpr int roulette_depth = 2;
/// Light vertices that tell from where light comes to a record.
constexpr int importance_vertices = 50;

Vec3f side_of(const SurfaceVertex& vertex) {
  return vertex.on_front() ? vertex.point().ng : -vertex.point().ng;
}

}  // namespace

GatheredLight::GatheredLight(const GatherInputs& inputs, const std::stop_token& stop)
    : in_(inputs) {
  // What is looked up has any number of events before.
  if (in_.maximum_events >= any_number_of_events)
    scattered_ = ScatteredLight(in_.light, in_.shrinkage, stop);
}

Spectrum GatheredLight::direct_light(const SurfaceVertex& vertex, const PathState& state,
                                     Sampler& sampler, uint64_t& rays) const {
  const auto reflect = [&](const DirectLight& light, ShadowAnswer& answer) {
    const Spectrum reflected = vertex.eval_cosine(light.wi, Lobes::diffuse) * light.radiance;
    if (reflected.is_zero()) return reflected;
    return reflected * arriving_share(in_.scene, light, nullptr,
                                      vertex.medium_toward(light.wi, state.medium),
                                      {vertex.wavelengths(), sampler}, rays, answer);
  };
  return sample_direct_lights<Spectrum>(in_.scene, Receiver(vertex, 1), {LightChoice::one, 1},
                                        sampler, reflect);
}

Spectrum GatheredLight::focused_light(const SurfaceVertex& vertex, int events, Sampler numbers,
                                      uint64_t& rays, Scratch& scratch) const {
  if (in_.focused.empty() || !(in_.merge_radius_sq > 0)) return {};
  const float radius = std::sqrt(in_.merge_radius_sq);
  const MergeDisk disk(vertex, radius);
  const bool both_sides = disk.both_sides();
  struct Part {
    Vec3f offset;
    Spectrum light;
  };
  const auto list = scratch.list<Part>();
  Spectrum sum;
  in_.focused.within(vertex.position(), both_sides ? vertex.point().ng : disk.side(), both_sides,
                     in_.merge_radius_sq, [&](uint32_t index, float) {
                       const LightVertexData& data = in_.focused.tree().data(index);
                       if (events + int(data.before) > in_.maximum_events) return;
                       const Vec3f offset = in_.focused.tree().key(index) - vertex.position();
                       const float share = disk.share(offset, data.side);
                       if (!(share > 0)) return;
                       const Vec3f wi = data.direction.unpack();
                       const float factor =
                           vertex.has_relief() ? vertex.irradiance_factor(wi) : 1.0f;
                       list->push_back({offset, vertex.eval(wi, Lobes::diffuse) *
                                                    data.flux.spectrum() * (share * factor)});
                       sum += list->back().light;
                     });
  if (sum.is_zero()) return sum;
  // One of them tells whether it is hidden: behind a thin wall, say.
  LaneDraw draw(sum, numbers.next_1d());
  for (size_t i = 0; i < list->size() && !draw.is_decided(); ++i) draw.offer(i, (*list)[i].light);
  const DiskCoverage covered(in_.scene, disk, rays);
  sum = draw.remaining(sum, [&](size_t i) { return covered.reaches(radius, (*list)[i].offset); });
  return sum * (1 / (pi * in_.merge_radius_sq * float(in_.light.path_count)));
}

RadianceSource::Incoming GatheredLight::incoming_through(const Medium* medium,
                                                         const SurfacePoint& from,
                                                         const Vec3f& direction, Sampler& sampler,
                                                         Scratch& scratch) const {
  Incoming result;
  PathState state;
  state.wavelengths = in_.light.wavelengths;
  state.medium = medium;
  state.footprint.scatter(Lobes::diffuse, 0.5f * inv_pi);
  Ray ray = spawn_ray(from, direction);
  SurfaceVertex vertex;
  float distance = 0, since_event = 0;
  uint64_t rays = 0;
  const auto go_on = [&](const Hit& hit, bool found) {
    if (state.medium)
      state.throughput *= state.medium->transmittance({ray.origin, ray.direction, hit.t},
                                                      state.wavelengths, sampler);
    distance += hit.t;
    since_event += hit.t;
    return found;
  };
  while (travel(in_.scene, state, ray, vertex, rays, sampler, go_on)) {
    if (state.depth == 0) result.distance = distance;
    sampler.start_vertex(uint32_t(state.depth));
    // That of the surface that gathers, and the one here.
    if (state.depth + 2 > in_.maximum_events) break;
    Lobes traced = vertex.lobes();
    if (any(vertex.lobes() & Lobes::diffuse)) {
      Spectrum sent = direct_light(vertex, state, sampler, rays);
      sent +=
          focused_light(vertex, state.depth + 1, sampler.fork(Fork::merge_sight), rays, scratch);
      Spectrum irradiance;
      if (vertex.is_lambertian() && !vertex.transmits() && !vertex.has_relief() &&
          scattered_.lookup(vertex.position(), side_of(vertex), since_event, scratch, irradiance)) {
        sent += vertex.diffuse_value() * irradiance;
        traced = traced & Lobes::specular;
      }
      result.radiance += state.throughput * sent;
    }
    if (!any(traced)) break;
    const Vec2f u = sampler.next_2d(), u_choice = sampler.next_2d();
    const BsdfSample sample = vertex.sample(u_choice.x, u, traced);
    if (sample.event == Lobes::none || sample.weight.is_zero()) break;
    state.throughput *= sample.weight;
    state.roulette_scale *= sqr(sample.eta);
    if (state.depth >= roulette_depth) {
      const float share = state.throughput.max_lane() * state.roulette_scale;
      if (!survive_roulette(state, share, u_choice.y)) break;
    }
    leave(vertex, sample, sample.pdf_solid_angle, state, ray);
    since_event = 0;
  }
  rays_.fetch_add(rays, std::memory_order_relaxed);
  return result;
}

bool GatheredLight::importance(const SurfacePoint& at, const Frame& frame,
                               const HemisphereGrid& grid, Scratch& scratch,
                               std::vector<float>& cell_importance) const {
  const SidedTree<LightVertexData>& tree = in_.light.tree;
  if (tree.empty()) return false;
  cell_importance.assign(size_t(grid.count()), 0);
  const Vec3f side = dot(frame.z, at.ng) < 0 ? -at.ng : at.ng;
  const auto borrowed = scratch.borrow<SidedTree<LightVertexData>::Neighbors>();
  SidedTree<LightVertexData>::Neighbors& neighbors = *borrowed;
  tree.nearest(at.position, side, false, importance_vertices, infinity, neighbors);
  for (size_t i = 0; i < neighbors.size(); ++i) {
    const LightVertexData& data = tree.tree().data(neighbors.index(i));
    const Vec3f local = frame.to_local(data.direction.unpack());
    if (data.specular || !(local.z > 0)) continue;
    cell_importance[size_t(grid.cell_of(local))] += data.flux.spectrum().max_lane();
  }
  return true;
}

}  // namespace kaustik
