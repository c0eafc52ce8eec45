#include "kaustik/photonmap/photon_map_integrator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kaustik/base/parallel.h"
#include "kaustik/photon/photon_file.h"

namespace kaustik {
namespace {

/// Of the picture's longer side: how far around what pixels show edges are looked for.
constexpr float reach_share = 0.04f;
/// Events before roulette on specular paths.
constexpr int roulette_depth = 4;
/// Distances between the pixels whose surfaces fill the cache, round by round: down to a third of
/// the least spacing of records, closer ones would find next to nothing that is not served.
constexpr int cache_strides[] = {8, 4, 2, 1};
bool is_last_stride(int stride, float minimum_spacing) {
  return stride == 1 || float(3 * stride) <= minimum_spacing;
}
/// Surfaces that a camera path sees blurred, behind a glossy event, ask for records in the rounds
/// of this stride and larger ones alone: what such records don't serve is gathered, for blurred
/// points may lie anywhere, and a record of its own for each would cost more than it serves.
constexpr int least_blurred_stride = 4;
/// Beams wider than so many pixels are blurred.
constexpr float blurred_pixels = 2;
/// Surfaces of one camera path that ask for records.
constexpr size_t cache_points_per_path = 4;

/// The largest radius is what this share of the photons take for their neighbours. What is sparser
/// is better estimated from fewer photons than from far ones: where the dim surroundings of a focus
/// reach into it for their neighbours, its light is counted twice. Their noise goes with the
/// passes; for stored maps, where it does not, the radius is twice that of a larger share.
constexpr float quantile = 0.75f, stored_quantile = 0.95f;
float typical_radius(const PhotonMap& map, int neighbors, bool stored) {
  return stored ? 2 * map.typical_radius(neighbors, stored_quantile)
                : map.typical_radius(neighbors, quantile);
}

/// The walk's vertex as the cache sees it, on the side of `normal`.
CachePoint cache_point_of(const CameraWalk& walk, const Vec3f& normal,
                          const PhotonMapSettings& settings) {
  const Footprint& footprint = walk.footprint();
  return {walk.vertex().point(), normal, 2 * std::min(footprint.width, footprint.sharp_width),
          settings.cache_tolerance(walk.events()),
          walk.vertex().medium_toward(normal, walk.medium())};
}

bool is_blurred(const CameraWalk& walk) {
  return walk.footprint().width > blurred_pixels * walk.footprint().sharp_width;
}

/// Of the walk's vertex: the camera's side gathers nothing on its way.
EyeLevel level_of(const CameraWalk& walk) { return {walk.events(), 0}; }

}  // namespace

struct PhotonMapIntegrator::Light final : KeptLight {
  uint64_t seed = 0;
  Wavelengths wavelengths;
  std::shared_ptr<const PhotonMaps> maps;
  GatherRadii radii;
  IrradianceMap precomputed;
  PassReport report;  ///< of the photons alone
};

struct PhotonMapIntegrator::State final : PassState {
  std::shared_ptr<const Light> photons;
  std::unique_ptr<ShadowMap> shadows;  ///< null: shadow rays alone
  ShadowReport shadow_report;
  ShadowSettings shadow_settings;
  std::unique_ptr<PhotonLight> light;
  std::unique_ptr<IrradianceCache> cache;          ///< null: not used
  std::shared_ptr<const SeenSurfaces> seen_edges;  ///< null: not known
};

PhotonMapIntegrator::PhotonMapIntegrator(const Arguments& arguments, const Scene& scene)
    : IlluminationModel(scene), settings_(arguments) {
  traits_.components = settings_.components;
  // One set of maps, which all samples of a pass share.
  traits_.most_wavelength_sets = 1;
  traits_.default_samples_per_pass = settings_.samples_per_pass;
  if ((scene.has_media() || scene.passes_straight()) && settings_.shadow_photons > 0)
    throw Error(ErrorKind::input,
                "shadow photons know nothing of media, null boundaries, holes and thin panes, and "
                "the scene has some",
                "set 'shadow_photons' to 0", arguments.place_of("shadow_photons"));
  if (settings_.photon_file.empty()) return;
  StoredPhotons stored = read_photon_file(settings_.photon_file);
  const auto refuse = [&](const std::string& message) {
    throw Error(ErrorKind::input, settings_.photon_file + " " + message,
                "trace the maps anew, from this scene and with these settings",
                settings_.photon_file_place);
  };
  if (!stored.fingerprint.matches(fingerprint_of(scene)))
    refuse(
        "holds photons of another scene, of this one before it was changed, or of another version "
        "of Kaustik (" +
        stored.scene + ", " + stored.fingerprint.counts + ")");
  if (!stored.settings.part.is_whole())
    throw Error(ErrorKind::input, settings_.photon_file + " holds only a part of the photons",
                "merge all parts, and give what that makes", settings_.photon_file_place);
  if (stored.settings.traced != settings_.light_pass.traced)
    refuse("was traced with another specular_sampling");
  if ((settings_.light_pass.caustic_photons > 0 && stored.settings.caustic_photons == 0) ||
      (settings_.light_pass.global_photons > 0 && stored.settings.global_photons == 0))
    refuse("was traced without photons that are needed here");
  if (scene.has_scattering() && settings_.light_pass.volume_photons > 0)
    throw Error(ErrorKind::input,
                "stored maps hold no photons of media, and a medium of this scene scatters light",
                "leave out 'photon_map', or set 'volume_photons' to 0 for a picture without that "
                "light",
                settings_.photon_file_place);
  if (!scene.gauges().empty())
    throw Error(
        ErrorKind::input,
        "stored maps hold no light that passes points in the air, which the camera measures",
        "leave out 'photon_map': each pass then traces photons of its own",
        settings_.photon_file_place);
  stored_wavelengths_ = stored.wavelengths;
  stored_maps_ = std::make_shared<const PhotonMaps>(std::move(stored.maps));
}

void PhotonMapIntegrator::check_stored_wavelengths(const Wavelengths& wavelengths) const {
  if (stored_wavelengths_ == wavelengths) return;
  const auto text = [](const Wavelengths& of) {
    return of.is_rgb() ? std::string("red, green and blue")
                       : fmt::format("{:g}, {:g}, {:g} and {:g} nm", of[0], of[1], of[2], of[3]);
  };
  throw Error(ErrorKind::input,
              fmt::format("{} holds photons of {}, this pass has light of {}",
                          settings_.photon_file, text(stored_wavelengths_), text(wavelengths)),
              "leave out 'photon_map': each pass then traces photons at its own wavelengths",
              settings_.photon_file_place);
}

std::shared_ptr<const LightPass> PhotonMapIntegrator::light_pass(
    uint64_t seed, const std::stop_token& stop) const {
  return light_pass_.get(seed, [&]() -> std::shared_ptr<const LightPass> {
    auto made = std::make_shared<const LightPass>(scene(), settings_.light_pass, seed, stop);
    return stop.stop_requested() ? nullptr : made;
  });
}

std::shared_ptr<const SeenSurfaces> PhotonMapIntegrator::seen_edges(
    uint64_t& rays, const std::stop_token& stop) const {
  // Not by the photons of a pass: passes don't know of one another.
  return seen_edges_.get(0, [&]() -> std::shared_ptr<const SeenSurfaces> {
    if (stop.stop_requested()) return nullptr;
    auto found = std::make_shared<SeenSurfaces>(scene());
    const Vec2i size = scene().film().size;
    found->find_edges(scene(), reach_share * float(std::max(size.x, size.y)), 0, rays, stop);
    return stop.stop_requested() ? nullptr : found;
  });
}

GatherRadii PhotonMapIntegrator::pass_radii(const PhotonMaps& maps, uint32_t index) const {
  const auto radius = [&](const PhotonMap& map, const EstimateSettings& estimate, float given) {
    const float first =
        given > 0 ? given : typical_radius(map, estimate.neighbors, stored_maps_ != nullptr);
    return std::min(
        pass_radius(first, index),
        radius_of_least_radiance(estimate.neighbors, map.mean_flux(), settings_.minimum_radiance));
  };
  return {radius(maps.caustic, settings_.caustic, settings_.caustic_radius),
          radius(maps.global, settings_.global, settings_.global_radius)};
}

GaugeDisks PhotonMapIntegrator::gauge_disks(const Pass& pass, uint64_t& rays) const {
  std::vector<float> radii;
  for (const PlacedGauge& gauge : scene().gauges()) {
    const float first = settings_.caustic_radius > 0
                            ? settings_.caustic_radius
                            : GaugeDisks::largest_radius(gauge.distance_around);
    radii.push_back(pass_radius(first, pass.stage()));
  }
  constexpr double golden = 0.6180339887498949;
  return {scene(), std::move(radii), float(std::fmod(double(pass.index) * golden, 1.0)), rays};
}

std::shared_ptr<const PhotonMaps> PhotonMapIntegrator::maps_of(
    const Pass& pass, PassReport& report, std::stop_token stop,
    const ProgressFunction& progress) const {
  if (stored_maps_) {
    check_stored_wavelengths(pass.wavelengths[0]);
    return stored_maps_;
  }
  const auto lights = light_pass(pass.seed, stop);
  if (!lights) return std::make_shared<const PhotonMaps>();
  GaugeDisks gauges;
  if (!scene().gauges().empty()) gauges = gauge_disks(pass, report.rays);
  auto maps = std::make_shared<const PhotonMaps>(
      lights->trace(pass.seed, pass.index, stop, progress, pass.wavelengths[0],
                    gauges.empty() ? nullptr : &gauges, pass.stage()));
  report.photons = maps->global.size() + maps->caustic.size() + maps->volume.size();
  report.rays += maps->global_report.rays + maps->caustic_report.rays + maps->volume_report.rays;
  if (!stop.stop_requested()) report.warnings = lights->warnings(*maps);
  return maps;
}

void PhotonMapIntegrator::keep_light(const std::shared_ptr<const KeptLight>& light) {
  const std::lock_guard lock(light_mutex_);
  keeps_light_ = true;
  first_light_ = std::dynamic_pointer_cast<const Light>(light);
}

std::shared_ptr<const KeptLight> PhotonMapIntegrator::kept_light() const {
  const std::lock_guard lock(light_mutex_);
  return first_light_;
}

std::shared_ptr<const PhotonMapIntegrator::Light> PhotonMapIntegrator::light_of(
    const Pass& pass, PassReport& report, std::stop_token stop,
    const ProgressFunction& progress) const {
  // Files of maps may change, what media scatter belongs to the media of one scene, and gauges are
  // the camera's.
  const bool is_kept = keeps_light_ && pass.index == 0 && !stored_maps_ &&
                       !scene().has_scattering() && scene().gauges().empty();
  if (is_kept) {
    const std::lock_guard lock(light_mutex_);
    if (first_light_ && first_light_->seed == pass.seed &&
        first_light_->wavelengths == pass.wavelengths[0]) {
      report.photons = first_light_->report.photons;
      report.warnings = first_light_->report.warnings;
      return first_light_;
    }
  }
  const auto light = std::make_shared<Light>();
  light->seed = pass.seed;
  light->wavelengths = pass.wavelengths[0];
  light->maps = maps_of(pass, light->report, stop, progress);
  // Stored maps are the same in every pass: shrinking their radii would trade bias for noise that
  // no number of passes removes.
  light->radii = pass_radii(*light->maps, stored_maps_ ? 0 : pass.stage());
  if (settings_.gathers)
    light->precomputed =
        precomputed_irradiance(scene(), settings_, *light->maps, light->radii, stop);
  light->report.rays += light->precomputed.rays();
  report = light->report;
  if (is_kept && !stop.stop_requested()) {
    const std::lock_guard lock(light_mutex_);
    first_light_ = light;
  }
  return light;
}

std::unique_ptr<PassState> PhotonMapIntegrator::prepare(const Pass& pass, SplatBuffer&,
                                                        std::stop_token stop,
                                                        const ProgressFunction& progress) const {
  auto state = std::make_unique<State>();
  // The light pass counts as one half, the cache as the other.
  state->photons = light_of(pass, state->report, stop, [&](double share) {
    if (progress) progress(0.5 * share);
  });
  if (stop.stop_requested()) return state;
  const Light& photons = *state->photons;
  add_shadow_photons(*state, pass, stop);
  state->light = std::make_unique<PhotonLight>(scene(), settings_, *photons.maps, photons.radii,
                                               photons.precomputed, state->shadows.get(),
                                               state->shadow_settings, pass);
  const bool wants_indirect = settings_.components.has(Component::indirect) ||
                              settings_.components.has(Component::specular);
  // Gauges are measured each by itself, and edges around them are of no use.
  const bool has_gauges = !scene().gauges().empty();
  if (settings_.gathers && settings_.cache && wants_indirect && settings_.global.neighbors > 0 &&
      !has_gauges)
    fill_cache(*state, pass, stop, [&](double share) {
      if (progress) progress(0.5 + 0.5 * share);
    });
  // They spare rays, and take more time than the first samples do.
  if (settings_.gathers && settings_.visibility && !photons.maps->caustic.empty() && !has_gauges)
    state->seen_edges = seen_edges(state->report.rays, stop);
  state->report.rays += state->light->rays();
  if (!stop.stop_requested()) add_warnings(*state);
  return state;
}

void PhotonMapIntegrator::add_shadow_photons(State& state, const Pass& pass,
                                             std::stop_token stop) const {
  if (settings_.shadow_photons == 0) return;
  state.shadows = std::make_unique<ShadowMap>(trace_shadow_photons(
      scene(), settings_.shadow_photons, pass.seed, pass.index, stop, state.shadow_report));
  state.report.rays += state.shadow_report.rays;
  state.report.photons += state.shadows->size();
  state.shadow_settings = settings_.shadows;
  const float first = settings_.shadow_radius > 0 ? settings_.shadow_radius
                                                  : state.shadows->tree().typical_radius(
                                                        settings_.shadows.neighbors, quantile);
  state.shadow_settings.maximum_radius = pass_radius(first, pass.stage());
}

/// What those of the light pass don't know of.
void PhotonMapIntegrator::add_warnings(State& state) const {
  std::vector<std::string>& warnings = state.report.warnings;
  warnings.insert(warnings.end(), settings_.notes.begin(), settings_.notes.end());
  if (state.shadows)
    for (const std::string& warning : state.shadow_report.warnings()) warnings.push_back(warning);
  if (state.cache && state.cache->rays_dropped() > 0)
    warnings.emplace_back(
        "the irradiance cache left out gather rays whose radiance is not finite: the light there "
        "is too dark; look for lights or reflectances that are far too large");
}

void PhotonMapIntegrator::fill_cache(State& state, const Pass& pass, std::stop_token stop,
                                     const ProgressFunction& progress) const {
  // Its errors have to vanish as well: all lengths shrink as the gather radii do.
  const float shrinkage = pass_radius(1, stored_maps_ ? 0 : pass.stage());
  CacheSettings cache_settings = settings_.cache_settings;
  cache_settings.quality *= shrinkage;
  cache_settings.minimum_spacing *= shrinkage;
  cache_settings.maximum_spacing *= shrinkage;
  state.cache = std::make_unique<IrradianceCache>(cache_settings);
  const Sampler sampler = Sampler::at(pass.seed, pass.index, Stream::cache, 0, 0);
  uint32_t round = 0;
  for (const int stride : cache_strides) {
    const Vec2i first = scene().film().crop_offset / stride;
    const Vec2i end =
        (scene().film().crop_offset + scene().film().crop_size + Vec2i(stride - 1)) / stride;
    std::vector<std::vector<CachePoint>> rows(size_t(end.y - first.y));
    parallel_blocks(rows.size(), 1, [&](size_t row, size_t, size_t) {
      for (int x = first.x; x < end.x && !stop.stop_requested(); ++x)
        collect_cache_points(Vec2i(x, first.y + int(row)) * stride, stride, pass, round, rows[row]);
    });
    std::vector<CachePoint> points;
    for (const auto& row : rows) {
      if (stop.stop_requested()) return;
      points.insert(points.end(), row.begin(), row.end());
    }
    state.cache->fill_round(points, *state.light, sampler, round++, stop);
    progress(double(round) / double(std::size(cache_strides)));
    if (is_last_stride(stride, cache_settings.minimum_spacing)) return;
  }
}

void PhotonMapIntegrator::collect_cache_points(const Vec2i& pixel, int stride, const Pass& pass,
                                               uint32_t round,
                                               std::vector<CachePoint>& points) const {
  const FilmSettings& film = scene().film();
  const uint64_t address = uint64_t(pixel.y) * uint64_t(film.size.x) + uint64_t(pixel.x) + 1;
  Sampler sampler = Sampler::at(pass.seed, pass.index, Stream::cache, address, round);
  const Vec2i corner = pixel - film.crop_offset;
  const Vec2f raster = Vec2f(float(corner.x), float(corner.y)) + sampler.next_2d() * float(stride);
  SampleSink nowhere{ComponentSet(), pass.wavelengths};
  CameraWalk walk(scene(), raster, sampler, nowhere, settings_.traced());
  const size_t first = points.size();
  while (walk.advance()) {
    const SurfaceVertex& vertex = walk.vertex();
    if (is_blurred(walk) && stride < least_blurred_stride) return;
    if (any(vertex.lobes() & Lobes::diffuse) && !settings_.approximates(level_of(walk))) {
      const Vec3f normal = vertex.facing_normal();
      points.push_back(cache_point_of(walk, normal, settings_));
      if (gathers_through(vertex)) points.push_back(cache_point_of(walk, -normal, settings_));
      if (points.size() - first >= cache_points_per_path) return;
    }
    if (specular_rays(walk) == 0 || !scatter_specular(walk, 1)) return;
  }
}

int PhotonMapIntegrator::specular_rays(const CameraWalk& walk) const {
  if (!any(walk.vertex().lobes() & settings_.traced()) ||
      !settings_.traces_specular(level_of(walk)))
    return 0;
  return walk.events() == 0 ? settings_.specular_samples : 1;
}

bool PhotonMapIntegrator::advance(const PassState& state, CameraWalk& walk) const {
  return walk.advance(&state_as<State>(state).light->volume());
}

bool PhotonMapIntegrator::reflect(const PassState& pass_state, CameraWalk& walk,
                                  const RadianceTracer& tracer) const {
  const auto& state = state_as<State>(pass_state);
  const int rays = specular_rays(walk);
  const bool traces_glossy = settings_.specular_sampling == SpecularSampling::importance;
  const int lights = settings_.count_at(settings_.light_samples, walk.events());
  ShadowVisibility visibility(state.shadows.get(), state.shadow_settings, walk.vertex(),
                              walk.events(), walk.work().scratch);
  LightRules rules;
  // Shadow photons lie on surfaces.
  if (walk.gauge() < 0) rules.visibility = &visibility;
  walk.add_direct_light(0, traces_glossy ? float(rays) : 0.0f, {settings_.light_choice, lights},
                        rules);
  add_photon_light(state, walk);
  if (rays == 0) return false;
  if (rays == 1) return scatter_specular(walk, 1);
  for (int i = 0; i < rays; ++i) {
    Sampler sampler = walk.sampler().split(Split::specular_ray, uint32_t(i));
    CameraWalk branch(walk, sampler);
    if (scatter_specular(branch, rays)) tracer.follow(branch);
  }
  return false;
}

bool PhotonMapIntegrator::scatter_specular(CameraWalk& walk, int rays) const {
  const Vec2f u = walk.sampler().next_2d(), u_choice = walk.sampler().next_2d();
  if (!walk.scatter(walk.vertex().lobes() & settings_.traced(), float(rays), u_choice.x, u))
    return false;
  return walk.events() <= roulette_depth || walk.survive(u_choice.y);
}

/// As on a white matt surface, but with what passes the gauge in place of photons around it.
void PhotonMapIntegrator::add_photon_light_at_gauge(const State& state, CameraWalk& walk) const {
  const SurfaceVertex& vertex = walk.vertex();
  const std::vector<Spectrum>& passing = state.photons->maps->gauges;
  if (!passing.empty() && walk.wants_photon_light(Component::caustic))
    walk.add_photon_light(Component::caustic,
                          vertex.diffuse_value() * passing[size_t(walk.gauge())]);
  if (settings_.global.neighbors <= 0 || !walk.wants_photon_light(Component::indirect)) return;
  const Spectrum irradiance =
      state.light->gather_irradiance(vertex, vertex.facing_normal(), walk.medium(), walk.sampler(),
                                     level_of(walk), walk.work().scratch);
  walk.add_photon_light(Component::indirect, vertex.diffuse_value() * irradiance);
}

void PhotonMapIntegrator::add_photon_light(const State& state, CameraWalk& walk) const {
  if (walk.gauge() >= 0) return add_photon_light_at_gauge(state, walk);
  const SurfaceVertex& vertex = walk.vertex();
  const Lobes local = vertex.lobes() & settings_.local();
  if (!any(local)) return;
  if (walk.wants_photon_light(Component::caustic)) {
    const SurfaceEdges* const edges =
        state.seen_edges ? state.seen_edges->edges_at(walk.raster(), vertex) : nullptr;
    walk.add_photon_light(Component::caustic,
                          state.light->seen_caustic(vertex, local, walk.events(), walk.sampler(),
                                                    edges, walk.work()));
  }
  if (settings_.global.neighbors <= 0 || !walk.wants_photon_light(Component::indirect)) return;
  const bool gathers = any(local & Lobes::diffuse) && !settings_.approximates(level_of(walk));
  if (gathers)
    walk.add_photon_light(Component::indirect, diffuse_radiance(vertex, [&](const Vec3f& normal) {
                            return diffuse_irradiance(state, walk, normal);
                          }));
  // Glossy lobes that are not traced: the approximate solution is all that is left for them.
  const Lobes approximated = gathers ? local & Lobes::glossy : local;
  if (any(approximated))
    walk.add_photon_light(
        Component::indirect,
        state.light->global(vertex, approximated, walk.events(), walk.sampler(), walk.work()));
}

Spectrum PhotonMapIntegrator::diffuse_irradiance(const State& state, CameraWalk& walk,
                                                 const Vec3f& normal) const {
  Spectrum irradiance;
  if (state.cache) {
    const CachePoint point = cache_point_of(walk, normal, settings_);
    // What is seen sharply was looked at while the cache was filled, so what few points slipped
    // through lie beside records that serve.
    const bool serves = !is_blurred(walk) || state.cache->serves(point);
    if (serves && state.cache->interpolate(point, irradiance)) return irradiance;
    if (!is_blurred(walk) && state.cache->interpolate(point, irradiance, 2)) return irradiance;
  }
  const SurfaceVertex& vertex = walk.vertex();
  return state.light->gather_irradiance(vertex, normal, vertex.medium_toward(normal, walk.medium()),
                                        walk.sampler(), level_of(walk), walk.work().scratch);
}

}  // namespace kaustik
