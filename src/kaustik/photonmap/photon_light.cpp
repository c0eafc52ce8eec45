#include "kaustik/photonmap/photon_light.h"

#include "kaustik/base/to_integer.h"
#include "kaustik/photon/coverage/merge_disk.h"
#include "kaustik/photonmap/covered_disk.h"
#include "kaustik/transport/direct_light.h"
#include "kaustik/transport/roulette.h"
#include "kaustik/transport/travel.h"
#include "kaustik/transport/visibility.h"

namespace kaustik {
namespace {

/// The level for which irradiance is computed beforehand: where most gather rays end.
constexpr int precomputed_level = 1;
/// Specular events that a gather ray follows before roulette.
constexpr int gather_roulette_depth = 4;
/// Gather rays average over so many directions that one volume photon out of these is enough.
constexpr size_t coarse_volume_stride = 8;
/// Chance of looking for what covers a disk where edges tell that it is whole: they may have missed
/// a small hole.
constexpr float asked_where_whole = 0.125f;

/// `estimate` as surfaces at a recursion level make it.
EstimateSettings at_level(const PhotonMapSettings& settings, const EstimateSettings& estimate,
                          float radius, int recursion) {
  EstimateSettings result = estimate;
  result.maximum_radius = radius;
  if (estimate.neighbors > 0)
    result.neighbors = settings.count_at(estimate.neighbors, recursion, 2);
  return result;
}

}  // namespace

IrradianceMap precomputed_irradiance(const Scene& scene, const PhotonMapSettings& settings,
                                     const PhotonMaps& maps, const GatherRadii& radii,
                                     const std::stop_token& stop) {
  return IrradianceMap(maps.global, maps.places,
                       at_level(settings, settings.global, radii.global, precomputed_level),
                       settings.visibility ? &scene : nullptr, stop);
}

PhotonLight::PhotonLight(const Scene& scene, const PhotonMapSettings& settings,
                         const PhotonMaps& maps, const GatherRadii& radii,
                         const IrradianceMap& precomputed, const ShadowMap* shadows,
                         const ShadowSettings& shadow_settings, const Pass& pass)
    : scene_(scene),
      wavelengths_(pass.wavelengths[0]),
      settings_(settings),
      maps_(maps),
      radii_(radii),
      precomputed_(precomputed),
      shadows_(shadows),
      shadow_settings_(shadow_settings) {
  if (!maps.volume.empty()) make_volume_maps(pass.stage());
  for (uint32_t shape = 0; shape < scene.surface_count(); ++shape) {
    const Lobes lobes = scene.surface(shape).traits.lobes;
    if (any(lobes & MergeDisk::keeping()) && !any(lobes & keeping()))
      edges_tell_what_keeps_ = false;
  }
}

void PhotonLight::make_volume_maps(uint32_t pass) {
  // What a disc blurs is two-dimensional, so the radii shrink as those on surfaces do (Knaus and
  // Zwicker 2011, section 5).
  const float shrinkage = pass_radius(1, pass);
  const Scene* const hides = settings_.visibility ? &scene_ : nullptr;
  volume_ = VolumePhotonMap(maps_.volume, settings_.volume_neighbors, shrinkage, hides);
  std::vector<VolumePhoton> few;
  for (size_t i = 0; i < maps_.volume.size(); i += coarse_volume_stride) {
    few.push_back(maps_.volume[i]);
    const size_t stands_for = std::min(coarse_volume_stride, maps_.volume.size() - i);
    few.back().flux *= float(stands_for);
  }
  coarse_volume_ = VolumePhotonMap(std::move(few), settings_.volume_neighbors, shrinkage, hides);
}

DensityEstimate PhotonLight::estimate(const PhotonMap& map, const SurfaceVertex& vertex,
                                      Lobes lobes, const EstimateSettings& settings,
                                      const Sampler& numbers, const ClearDisk& clear,
                                      const Work& work) const {
  if (map.empty()) return {};
  if (!settings_.visibility) return map.radiance(vertex, lobes, settings, work.scratch);
  const SurfaceSight sight(scene_, vertex.position(), vertex.point().shape, work.rays, clear);
  return map.radiance(vertex, lobes, settings, work.scratch, {&sight, Sampler(numbers).next_1d()});
}

DensityEstimate PhotonLight::caustic_estimate(const SurfaceVertex& vertex, Lobes lobes,
                                              int recursion, const Sampler& sampler,
                                              const ClearDisk& clear, const Work& work) const {
  return estimate(maps_.caustic, vertex, lobes,
                  at_level(settings_, settings_.caustic, radii_.caustic, recursion),
                  sampler.fork(Fork::caustic_sight), clear, work);
}

Spectrum PhotonLight::seen_caustic(const SurfaceVertex& vertex, Lobes lobes, int recursion,
                                   const Sampler& sampler, const SurfaceEdges* edges,
                                   const Work& work) const {
  const ClearDisk clear = edges ? edges->clear_disk(vertex.position()) : ClearDisk();
  const DensityEstimate found = caustic_estimate(vertex, lobes, recursion, sampler, clear, work);
  if (!settings_.visibility || found.value.is_zero()) return found.value;
  const PhotonSurroundings around{scene_, vertex, keeping()};
  const bool likely_whole =
      edges && edges_tell_what_keeps_ && edges->is_whole(vertex.position(), found.radius);
  return found.value * inverse_covered_share(around, settings_.caustic, found.radius,
                                             likely_whole ? asked_where_whole : 1.0f,
                                             sampler.fork(Fork::caustic_cover), work.rays);
}

Lobes PhotonLight::keeping() const {
  return scene_.film().quantity == Quantity::irradiance ? Lobes::all : settings_.local();
}

Spectrum PhotonLight::global(const SurfaceVertex& vertex, Lobes lobes, int recursion,
                             const Sampler& sampler, const Work& work) const {
  return estimate(maps_.global, vertex, lobes,
                  at_level(settings_, settings_.global, radii_.global, recursion),
                  sampler.fork(Fork::global_sight), {}, work)
      .value;
}

Spectrum PhotonLight::gathered_global(const SurfaceVertex& vertex, Lobes lobes, int recursion,
                                      const Sampler& sampler, const Work& work) const {
  const Vec3f& ng = vertex.point().ng;
  const SurfaceSight sight(scene_, vertex.position(), vertex.point().shape, work.rays);
  Spectrum irradiance;
  // Relief is left out: from a gather ray's distance its bent normals even out.
  if ((vertex.lobes() & lobes) != Lobes::diffuse || vertex.transmits() ||
      !precomputed_.lookup(vertex.position(), vertex.on_front() ? ng : -ng, irradiance,
                           work.scratch, settings_.visibility ? &sight : nullptr))
    return global(vertex, lobes, recursion, sampler, work);
  return vertex.diffuse_value() * irradiance;
}

Spectrum PhotonLight::gathered_indirect(const SurfaceVertex& vertex, const Medium* medium,
                                        Lobes lobes, Sampler& sampler, const EyeLevel& at,
                                        const Work& work) const {
  if (settings_.approximates(at) || !any(lobes & vertex.lobes() & Lobes::diffuse))
    return gathered_global(vertex, lobes, at.recursion, sampler, work);
  Spectrum light = diffuse_radiance(vertex, [&](const Vec3f& normal) {
    return gather_irradiance(vertex, normal, vertex.medium_toward(normal, medium), sampler, at,
                             work.scratch);
  });
  if (any(lobes & vertex.lobes() & Lobes::glossy))
    light += global(vertex, Lobes::glossy, at.recursion, sampler, work);
  return light;
}

Spectrum PhotonLight::reflected_direct_light(const SurfaceVertex& vertex, const Medium* medium,
                                             Lobes lobes, int recursion, Sampler& sampler,
                                             const Work& work) const {
  ShadowVisibility sight(shadows_, shadow_settings_, vertex, recursion, work.scratch);
  const auto reflect = [&](const DirectLight& light, ShadowAnswer& answer) {
    const Spectrum reflected = vertex.eval_cosine(light.wi, lobes) * light.radiance;
    if (reflected.is_zero()) return reflected;
    return reflected * arriving_share(scene_, light, &sight, vertex.medium_toward(light.wi, medium),
                                      {vertex.wavelengths(), sampler}, work.rays, answer);
  };
  return sample_direct_lights<Spectrum>(scene_, Receiver(vertex, recursion),
                                        {settings_.light_choice, 1}, sampler, reflect);
}

Spectrum PhotonLight::sent_by(const SurfaceVertex& vertex, const Medium* medium, Sampler& sampler,
                              const EyeLevel& level, const Work& work) const {
  const Lobes local = vertex.lobes() & settings_.local();
  if (!any(local)) return {};
  // One after the other: which numbers they draw must not be left to the compiler.
  Spectrum sent = reflected_direct_light(vertex, medium, local, level.recursion, sampler, work);
  sent += caustic(vertex, local, level.recursion, sampler, work);
  sent += gathered_indirect(vertex, medium, local, sampler, level, work);
  return sent;
}

RadianceSource::Incoming PhotonLight::gathered(const Medium* medium, const SurfacePoint& from,
                                               const Vec3f& direction, Sampler& sampler,
                                               const EyeLevel& at, Scratch& scratch) const {
  Incoming result;
  PathState state;
  state.wavelengths = wavelengths_;
  state.medium = medium;
  state.footprint.scatter(Lobes::diffuse, 0.5f * inv_pi);
  Ray ray = spawn_ray(from, direction);
  SurfaceVertex vertex;
  float distance = 0;
  uint64_t rays = 0;
  const Work work{rays, scratch};
  const auto go_on = [&](const Hit& hit, bool found) {
    if (state.medium) {
      result.radiance +=
          state.throughput *
          coarse_volume_.radiance(ray, hit.t, *state.medium, state.wavelengths, sampler, work);
      state.throughput *= state.medium->transmittance({ray.origin, ray.direction, hit.t},
                                                      state.wavelengths, sampler);
    }
    distance += hit.t;
    return found;
  };
  while (travel(scene_, state, ray, vertex, rays, sampler, go_on)) {
    if (state.depth == 0) result.distance = distance;
    sampler.start_vertex(uint32_t(state.depth));
    const EyeLevel level{at.recursion + 1 + state.depth, at.gathers + 1};
    result.radiance += state.throughput * sent_by(vertex, state.medium, sampler, level, work);
    const Lobes traced = vertex.lobes() & settings_.traced();
    if (!any(traced) || !settings_.traces_specular(level)) break;
    const Vec2f u = sampler.next_2d(), u_choice = sampler.next_2d();
    const BsdfSample sample = vertex.sample(u_choice.x, u, traced);
    if (sample.event == Lobes::none || sample.weight.is_zero()) break;
    state.throughput *= sample.weight;
    state.roulette_scale *= sqr(sample.eta);
    if (state.depth >= gather_roulette_depth) {
      const float share = state.throughput.max_lane() * state.roulette_scale;
      if (!survive_roulette(state, share, u_choice.y)) break;
    }
    leave(vertex, sample, sample.pdf_solid_angle, state, ray);
  }
  rays_.fetch_add(rays, std::memory_order_relaxed);
  return result;
}

bool PhotonLight::importance(const SurfacePoint& at, const Frame& frame, const HemisphereGrid& grid,
                             Scratch& scratch, std::vector<float>& cell_importance) const {
  if (maps_.global.empty() || settings_.global.neighbors <= 0) return false;
  cell_importance.assign(size_t(grid.count()), 0);
  std::vector<int>* counts = nullptr;
  std::vector<int> count_storage;
  if (settings_.importance_by_average) {
    count_storage.assign(size_t(grid.count()), 0);
    counts = &count_storage;
  }
  const Vec3f side = dot(frame.z, at.ng) < 0 ? -at.ng : at.ng;
  maps_.global.visit_nearest(at.position, side, settings_.importance_photons, infinity, scratch,
                             [&](const Photon& photon, const Vec3f& position) {
                               const Vec3f local =
                                   frame.to_local(photon.incident_direction(position, at.position));
                               if (!(local.z > 0)) return;
                               const auto cell = size_t(grid.cell_of(local));
                               cell_importance[cell] += photon.flux.spectrum().max_lane();
                               if (counts) ++(*counts)[cell];
                             });
  if (counts)
    for (size_t cell = 0; cell < cell_importance.size(); ++cell)
      if ((*counts)[cell] > 0) cell_importance[cell] /= float((*counts)[cell]);
  return true;
}

Spectrum PhotonLight::gather_irradiance(const SurfaceVertex& vertex, const Vec3f& n,
                                        const Medium* medium, Sampler& sampler, const EyeLevel& at,
                                        Scratch& scratch) const {
  // A gather ray that gathers again sends one: more of them would multiply from level to level.
  const int samples =
      at.gathers > 0 ? 1 : settings_.count_at(settings_.diffuse_samples, at.recursion);
  HemisphereGrid grid{settings_.gather_theta_cells, settings_.gather_phi_cells};
  // With fewer photons than cells the grid would be mostly empty.
  while (grid.count() > settings_.importance_photons &&
         (grid.theta_cells > 1 || grid.phi_cells > 1)) {
    grid.theta_cells = std::max(1, grid.theta_cells / 2);
    grid.phi_cells = std::max(1, grid.phi_cells / 2);
  }
  const Frame frame(n);
  // Gather rays that gather again have another one.
  const auto list = scratch.list<float>();
  std::vector<float>& cells = *list;
  double total = 0;
  if (importance(vertex.point(), frame, grid, scratch, cells))
    for (const float cell : cells) total += cell;
  const float floor = total > 0 ? settings_.importance_floor : 1;
  Spectrum sum;
  for (int i = 0; i < samples; ++i) {
    Sampler branch = sampler.split(Split::gather_ray, uint32_t(i));
    const Vec2f u = branch.next_2d();
    float u_cell = (branch.next_1d() + float(i)) / float(samples);
    int cell;
    if (u_cell < floor) {
      cell = to_integer(u_cell / floor * float(grid.count()), 0, grid.count() - 1);
    } else {
      double left = (u_cell - floor) / (1 - floor) * total;
      cell = 0;
      while (cell + 1 < grid.count() && left >= cells[size_t(cell)]) left -= cells[size_t(cell++)];
    }
    // Density relative to the grid that draws all cells alike.
    const double by_photons = total > 0 ? double(cells[size_t(cell)]) / total * grid.count() : 0.0;
    const auto p = float(floor + (1 - floor) * by_photons);
    if (!(p > 0)) continue;
    const Vec3f direction = frame.to_world(grid.direction(cell, u));
    if (dot(direction, vertex.point().ng) * dot(n, vertex.point().ng) <= 0) continue;
    sum += gathered(medium, vertex.point(), direction, branch, at, scratch).radiance *
           (pi / (p * float(samples)));
  }
  return sum;
}

}  // namespace kaustik
