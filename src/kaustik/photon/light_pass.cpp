#include "kaustik/photon/light_pass.h"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <numeric>

#include "kaustik/base/parallel.h"
#include "kaustik/base/sampler.h"
#include "kaustik/transport/visibility.h"

namespace kaustik {
namespace {

constexpr size_t photons_per_block = 2048;

/// Where a photon comes from, which its record does not tell.
struct PhotonOrigin {
  uint32_t path = 0;   ///< number of its light path in the pass
  uint32_t level = 0;  ///< events before
};

/// Photons in the order in which they were stored.
struct PhotonList {
  std::vector<Vec3f> positions;
  std::vector<Photon> photons;
  std::vector<PhotonOrigin> origins;  ///< parallel, or empty: not noted

  void reserve(size_t count) {
    positions.reserve(count);
    photons.reserve(count);
  }
  /// `path`: its number in the pass.
  void add(const LightVertex& at, uint32_t path, float scale) {
    const SurfaceVertex& vertex = at.vertex;
    const Vec3f& ng = vertex.point().ng;
    const float cos_geometric = dot(vertex.wo(), ng);
    const float cos_shading = dot(vertex.wo(), vertex.normal());
    if (!(std::fabs(cos_geometric) > 0)) return;
    // Density on the surface counts flux by the geometric cosine, shading by the other. Normals of
    // a relief change within the disk of an estimate, so that has to use its own.
    const float factor =
        vertex.has_relief() ? 1.0f : std::fabs(cos_shading) / std::fabs(cos_geometric);
    Photon photon;
    photon.flux = at.state.throughput * (scale * factor);
    photon.distance = at.distance;
    photon.direction = PackedDirection(vertex.wo());
    photon.on_front = cos_geometric > 0;
    photon.path = path;
    photon.side = CoarseNormal(cos_geometric > 0 ? ng : -ng);
    positions.push_back(vertex.position());
    photons.push_back(photon);
  }
};

/// The lists one after another; in parallel, they are large.
PhotonList concatenate(const std::vector<const PhotonList*>& lists) {
  std::vector<size_t> begins;
  size_t total = 0;
  for (const PhotonList* list : lists) {
    begins.push_back(total);
    total += list->photons.size();
  }
  PhotonList result;
  result.positions.resize(total);
  result.photons.resize(total);
  parallel_blocks(lists.size(), 16, [&](size_t begin, size_t end, size_t) {
    for (size_t i = begin; i < end; ++i) {
      const auto to = std::ptrdiff_t(begins[i]);
      std::copy(lists[i]->positions.begin(), lists[i]->positions.end(),
                result.positions.begin() + to);
      std::copy(lists[i]->photons.begin(), lists[i]->photons.end(), result.photons.begin() + to);
    }
  });
  return result;
}

/// A share of a gauge's irradiance.
struct GaugeLight {
  uint32_t gauge = 0;
  Spectrum irradiance;  ///< W/m²
};

/// In the order in which it came, so that the bits are the same for any threads.
std::vector<Spectrum> sum_of(const std::vector<GaugeLight>& lights, size_t gauge_count) {
  std::vector<std::array<double, Spectrum::lane_count>> sums(gauge_count);
  for (const GaugeLight& light : lights)
    for (int lane = 0; lane < Spectrum::lane_count; ++lane)
      sums[light.gauge][size_t(lane)] += double(light.irradiance[lane]);
  std::vector<Spectrum> result(gauge_count);
  for (size_t i = 0; i < gauge_count; ++i)
    result[i] = {float(sums[i][0]), float(sums[i][1]), float(sums[i][2]), float(sums[i][3])};
  return result;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Lobes without(Lobes set, Lobes removed) { return Lobes(uint8_t(set) & ~uint8_t(removed)); }

}  // namespace

void LightCounts::add(const LightCounts& other) {
  emitted += other.emitted;
  stored += other.stored;
  nothing += other.nothing;
  arrived += other.arrived;
  escaped += other.escaped;
  absorbed += other.absorbed;
  too_long += other.too_long;
  stopped += other.stopped;
  stored_flux += other.stored_flux;
}

LightCounts MapReport::total() const {
  LightCounts sum;
  for (const LightCounts& counts : lights) sum.add(counts);
  return sum;
}

/// What tracing leaves: photons for both maps (caustic photons may go on as global ones).
struct LightPass::Deposits {
  PhotonList global, caustic;
  std::vector<VolumePhoton> volume;
  std::vector<GaugeLight> gauges;
  MapReport report;
};

/// LightPathLimits::largest_weight in the first pass; it grows with the passes, so that the light
/// which it cuts off comes back in the mean. A single photon of a thousand times the others' flux
/// would be a spot in the picture, and a bright haze about every gather ray that finds it.
constexpr float largest_first_weight = 10;

/// Traces one block of photons of one light.
class LightPass::Tracer {
 public:
  /// `first_path`: how many paths the pass has of other kinds and lights before these.
  Tracer(const LightPass& pass, Kind kind, int light, uint32_t count, uint32_t first_path,
         const Address& address, bool notes_origins)
      : pass_(pass),
        wavelengths_(address.wavelengths),
        largest_weight_(largest_first_weight * std::cbrt(float(address.stage) + 1)),
        kind_(kind),
        light_(light),
        first_path_(first_path),
        notes_origins_(notes_origins),
        gauges_(kind == Kind::caustic ? address.gauges : nullptr),
        scale_(1.0f / float(count)),
        storing_(without(Lobes::all, pass.settings_.traced | Lobes::delta)),
        stores_everywhere_(pass.scene_.film().quantity == Quantity::irradiance) {
    if (kind != Kind::volume) (kind == Kind::global ? global : caustic).reserve(photons_per_block);
  }

  /// Photons `begin` to `end`; `sampler_of(i)` gives the random numbers of the i-th.
  template <typename SamplerOf>
  void trace(uint32_t begin, uint32_t end, const SamplerOf& sampler_of) {
    // What specular events begin and a medium scatters is the global photons', unless they are made
    // by re-radiation.
    const MediumEvents in_media = kind_ != Kind::caustic      ? MediumEvents::follow
                                  : pass_.settings_.reradiate ? MediumEvents::after_events
                                                              : MediumEvents::stop;
    LightPathLimits limits{pass_.settings_.maximum_events, pass_.settings_.traced, in_media,
                           largest_weight_};
    limits.gauges = gauges_;
    const auto start = [&](uint32_t photon) { return emit(sampler_of(photon)); };
    const auto on_surface = [this](const LightVertex& at) {
      switch (kind_) {
        case Kind::global:
          return meet_global(at);
        case Kind::caustic:
          return meet_caustic(at);
        case Kind::volume:
          break;
      }
      return Lobes::all;
    };
    const auto on_gauge = [this](const LightAtGauge& at) { pass_gauge(at); };
    const auto on_medium_vertex = [this](const LightMediumVertex& at) { store(at); };
    const LightPathCounts ends =
        kind_ == Kind::volume ? trace_light_paths(pass_.scene_, begin, end, limits, start,
                                                  Handlers{on_surface, on_medium_vertex})
        : gauges_             ? trace_light_paths(pass_.scene_, begin, end, limits, start,
                                                  Handlers{on_surface, on_gauge})
                  : trace_light_paths(pass_.scene_, begin, end, limits, start, on_surface);
    rays += ends.rays;
    counts.escaped += ends.escaped;
    counts.absorbed += ends.absorbed + ends.absorbed_in_media;
    counts.too_long += ends.too_long;
    counts.stopped += ends.stopped;
  }

  PhotonList global, caustic;
  std::vector<GaugeLight> at_gauges;  ///< in the order of their coming
  std::vector<VolumePhoton> volume;
  std::vector<PhotonOrigin> volume_origins;  ///< parallel, or empty: not noted
  LightCounts counts;
  uint64_t rays = 0;

  /// All photons, with keys by which they are drawn. Only if origins are noted.
  std::vector<PhotonDraw::Offer> offers(uint64_t seed) const {
    std::vector<PhotonDraw::Offer> all;
    const auto add = [&](DrawnPhoton::Map map, const Vec3f& position, const StoredSpectrum& flux,
                         const PhotonOrigin& origin) {
      // A path has one photon at each level.
      const uint64_t path = hash_mix(hash_mix(seed, uint64_t(kind_)), origin.path);
      all.push_back(
          {hash_mix(path, origin.level), {position, flux, map, uint32_t(light_), origin.level}});
    };
    const auto add_list = [&](DrawnPhoton::Map map, const PhotonList& list) {
      for (size_t i = 0; i < list.photons.size(); ++i)
        add(map, list.positions[i], list.photons[i].flux, list.origins[i]);
    };
    add_list(DrawnPhoton::Map::global, global);
    add_list(DrawnPhoton::Map::caustic, caustic);
    for (size_t i = 0; i < volume.size(); ++i)
      add(DrawnPhoton::Map::volume, volume[i].position, volume[i].flux, volume_origins[i]);
    return all;
  }

 private:
  std::optional<LightPath> emit(Sampler sampler) {
    const EmissionSampler& emission =
        kind_ == Kind::caustic ? *pass_.caustic_emission_ : *pass_.global_emission_;
    const Vec2f u_position = sampler.next_2d(), u_direction = sampler.next_2d();
    const EmittedRay emitted =
        emission.sample(light_, u_position, u_direction, sampler.next_1d(), wavelengths_);
    ++counts.emitted;
    if (emitted.flux.is_zero()) {
      ++counts.nothing;
      return std::nullopt;
    }
    return LightPath(emitted.ray, emitted.flux, pass_.scene_.light_medium(light_),
                     pass_.settings_.traced, sampler, wavelengths_);
  }

  Lobes meet_global(const LightVertex& at) {
    if (at.path_class.events() == 0) ++counts.arrived;
    if (at.path_class.diffuse_events() > 0) {
      store(at, global);
      return Lobes::all;
    }
    // With re-radiation the caustic photons bring what specular events began.
    const bool brought = pass_.settings_.reradiate && pass_.settings_.caustic_photons > 0;
    return brought ? without(Lobes::all, pass_.settings_.traced) : Lobes::all;
  }

  Lobes meet_caustic(const LightVertex& at) {
    const Lobes traced = at.vertex.lobes() & pass_.settings_.traced;
    if (at.path_class.events() == 0) return traced;
    if (at.path_class.diffuse_events() > 0) {
      store(at, global);
      return Lobes::all;
    }
    store(at, caustic);
    return pass_.settings_.reradiate ? Lobes::all : traced;
  }

  void store(const LightVertex& at, PhotonList& list) {
    if (!stores_everywhere_ && !any(at.vertex.lobes() & storing_)) return;
    list.add(at, first_path_ + at.path, scale_);
    if (notes_origins_ && list.origins.size() < list.photons.size())
      list.origins.push_back({first_path_ + at.path, uint32_t(at.path_class.events())});
    ++counts.stored;
    counts.stored_flux += double(at.state.throughput.max_lane()) * scale_;
  }

  /// Caustic light that passes a disk. Light from the lamp itself is sampled.
  void pass_gauge(const LightAtGauge& at) {
    if (at.path_class.events() == 0 || at.path_class.diffuse_events() > 0) return;
    const GaugeDisks::Crossing& crossing = at.crossing;
    const float radius_sq = sqr(gauges_->radius(crossing.gauge));
    const float weight = 1 - crossing.offset_sq / radius_sq;
    if (!(weight > 0) || at.flux.is_zero()) return;
    const SurfacePoint& gauge = pass_.scene_.gauges()[crossing.gauge].point;
    if (!is_unobstructed(pass_.scene_, spawn_ray_to(gauge, crossing.position), rays)) return;
    const float density =
        2 * weight / (pi * radius_sq) * gauges_->inverse_share(crossing.gauge) * scale_;
    at_gauges.push_back({crossing.gauge, at.flux * density});
  }

  void store(const LightMediumVertex& at) {
    VolumePhoton photon;
    photon.position = at.position;
    photon.flux = at.flux * scale_;
    photon.direction = PackedDirection(at.wo);
    photon.medium = &at.medium;
    volume.push_back(photon);
    if (notes_origins_)
      volume_origins.push_back({first_path_ + at.path, uint32_t(at.path_class.events())});
    ++counts.stored;
    counts.stored_flux += double(photon.flux.max_lane());
  }

  const LightPass& pass_;
  Wavelengths wavelengths_;
  float largest_weight_;
  Kind kind_;
  int light_;
  uint32_t first_path_;
  bool notes_origins_;
  const GaugeDisks* gauges_;  ///< null: none
  float scale_;
  Lobes storing_;
  bool stores_everywhere_;  ///< irradiance is asked for on mirrors and glass too
};

LightPass::LightPass(const Scene& scene, const LightPassSettings& settings, uint64_t seed,
                     const std::stop_token& stop)
    : scene_(scene),
      settings_(settings),
      global_emission_(std::make_unique<EmissionSampler>(scene)) {
  if (settings_.caustic_photons > 0) {
    caustic_emission_ = std::make_unique<EmissionSampler>(scene, settings_.traced,
                                                          settings_.target_budget, settings_.aim);
    target_count_ = caustic_emission_->target_count();
  }
  global_shares_ = train(Kind::global, settings_.global_photons, seed, stop);
  caustic_shares_ = train(Kind::caustic, settings_.caustic_photons, seed, stop);
  volume_shares_ =
      train(Kind::volume, scene.has_scattering() ? settings_.volume_photons : 0, seed, stop);
}

std::vector<uint32_t> LightPass::train(Kind kind, uint32_t total, uint64_t seed,
                                       const std::stop_token& stop) const {
  const size_t lights = scene_.lights().size();
  if (total == 0 || lights == 0 || (kind == Kind::caustic && target_count_ == 0))
    return std::vector<uint32_t>(lights, 0);
  std::vector<double> arriving(lights), power(lights);
  for (size_t i = 0; i < lights; ++i) power[i] = scene_.lights()[i]->traits().power.sum();
  if (lights > 1) {
    const auto tries = uint32_t(std::clamp<size_t>(total / 4 / lights, 64, 16384));
    Deposits deposits;
    const ProgressFunction nobody;
    WorkCounter counter(0, nobody);
    trace_kind(kind, std::vector<uint32_t>(lights, tries), {seed, 0, 0, {}}, Stream::training, stop,
               counter, deposits);
    for (size_t i = 0; i < lights; ++i) arriving[i] = deposits.report.lights[i].stored_flux;
  } else {
    arriving = power;
  }
  return share_photons(total, arriving, power);
}

std::vector<LightPass::Block> LightPass::blocks_of(Kind kind,
                                                   const std::vector<uint32_t>& shares) const {
  std::vector<Block> blocks;
  // Paths of both kinds may end in one map.
  uint32_t first_path = kind == Kind::caustic ? settings_.global_photons : 0;
  for (size_t light = 0; light < shares.size(); ++light) {
    for (uint32_t begin = 0; begin < shares[light]; begin += uint32_t(photons_per_block))
      blocks.push_back({int(light), first_path, begin,
                        std::min(shares[light], begin + uint32_t(photons_per_block))});
    first_path += shares[light];
  }
  return blocks;
}

std::unique_ptr<LightPass::Tracer> LightPass::traced(const Block& block, Kind kind, uint32_t share,
                                                     const Address& address, Stream stream,
                                                     bool notes_origins) const {
  auto tracer = std::make_unique<Tracer>(*this, kind, block.light, share, block.first_path, address,
                                         notes_origins);
  // Kinds draw from different addresses even where they share a stream (training).
  const uint64_t element = uint64_t(block.light) * 2 + (kind == Kind::caustic ? 1 : 0) +
                           (kind == Kind::volume ? uint64_t(1) << 32 : 0);
  tracer->trace(block.begin, block.end, [&](uint32_t photon) {
    return Sampler::at(address.seed, address.index, stream, element, photon);
  });
  return tracer;
}

void LightPass::trace_kind(Kind kind, const std::vector<uint32_t>& shares, const Address& address,
                           Stream stream, std::stop_token stop, WorkCounter& counter,
                           Deposits& deposits) const {
  deposits.report.lights.assign(shares.size(), {});
  std::vector<Block> blocks = blocks_of(kind, shares);
  if (stream != Stream::training) {
    const size_t total = blocks.size();
    blocks.resize(total * (settings_.part.index + 1) / settings_.part.count);
    const size_t before = total * settings_.part.index / settings_.part.count;
    blocks.erase(blocks.begin(), blocks.begin() + std::ptrdiff_t(before));
  }
  std::vector<std::unique_ptr<Tracer>> results(blocks.size());
  parallel_blocks(blocks.size(), 1, [&](size_t i, size_t, size_t) {
    if (stop.stop_requested()) return;
    const Block& block = blocks[i];
    results[i] = traced(block, kind, shares[size_t(block.light)], address, stream, false);
    counter.add(block.end - block.begin);
  });
  if (stop.stop_requested()) return;
  std::vector<const PhotonList*> global, caustic;
  for (size_t i = 0; i < blocks.size(); ++i) {
    if (!results[i]) continue;
    global.push_back(&results[i]->global);
    caustic.push_back(&results[i]->caustic);
    deposits.volume.insert(deposits.volume.end(), results[i]->volume.begin(),
                           results[i]->volume.end());
    deposits.gauges.insert(deposits.gauges.end(), results[i]->at_gauges.begin(),
                           results[i]->at_gauges.end());
    deposits.report.lights[size_t(blocks[i].light)].add(results[i]->counts);
    deposits.report.rays += results[i]->rays;
  }
  deposits.global = concatenate(global);
  deposits.caustic = concatenate(caustic);
}

DrawnPhotons LightPass::draw(uint64_t seed, uint32_t index, size_t most, std::stop_token stop,
                             const Wavelengths& wavelengths) const {
  const Address address{seed, index, index, wavelengths};
  PhotonDraw draw(most);
  const auto offer_kind = [&](Kind kind, const std::vector<uint32_t>& shares, Stream stream) {
    const std::vector<Block> blocks = blocks_of(kind, shares);
    parallel_blocks(blocks.size(), 1, [&](size_t i, size_t, size_t) {
      if (stop.stop_requested()) return;
      const uint32_t share = shares[size_t(blocks[i].light)];
      draw.offer(traced(blocks[i], kind, share, address, stream, true)->offers(seed));
    });
  };
  offer_kind(Kind::caustic, caustic_shares_, Stream::photon_caustic);
  offer_kind(Kind::global, global_shares_, Stream::photon_global);
  offer_kind(Kind::volume, volume_shares_, Stream::photon_volume);
  return draw.take();
}

std::vector<uint32_t> LightPass::place_shares() const {
  if (settings_.place_stride == 0) return {};
  std::vector<uint32_t> shares = global_shares_;
  for (uint32_t& share : shares) share /= settings_.place_stride;
  return shares;
}

std::vector<SurfaceSide> LightPass::trace_places(const Address& address, std::stop_token stop,
                                                 WorkCounter& counter) const {
  Deposits deposits;
  trace_kind(Kind::global, place_shares(), address, Stream::photon_place, stop, counter, deposits);
  std::vector<SurfaceSide> places;
  places.reserve(deposits.global.photons.size());
  for (size_t i = 0; i < deposits.global.photons.size(); ++i)
    places.push_back({deposits.global.positions[i], deposits.global.photons[i].side});
  return places;
}

PhotonMaps LightPass::trace(uint64_t seed, uint32_t index, std::stop_token stop,
                            const ProgressFunction& progress, const Wavelengths& wavelengths,
                            const GaugeDisks* gauges, std::optional<uint32_t> stage) const {
  const Address address{seed, index, stage.value_or(index), wavelengths, gauges};
  const auto start = std::chrono::steady_clock::now();
  uint64_t total = 0;
  for (const auto& shares : {caustic_shares_, global_shares_, volume_shares_, place_shares()})
    total += std::accumulate(shares.begin(), shares.end(), uint64_t(0));
  WorkCounter counter(total, progress);
  Deposits caustic, global, volume;
  trace_kind(Kind::caustic, caustic_shares_, address, Stream::photon_caustic, stop, counter,
             caustic);
  trace_kind(Kind::global, global_shares_, address, Stream::photon_global, stop, counter, global);
  trace_kind(Kind::volume, volume_shares_, address, Stream::photon_volume, stop, counter, volume);
  if (!caustic.global.photons.empty() && !stop.stop_requested())
    global.global = concatenate({&global.global, &caustic.global});
  caustic.report.target_count = target_count_;
  PhotonMaps maps;
  maps.places = trace_places(address, stop, counter);
  maps.global_report = std::move(global.report);
  maps.caustic_report = std::move(caustic.report);
  maps.volume_report = std::move(volume.report);
  maps.volume = std::move(volume.volume);
  if (gauges) maps.gauges = sum_of(caustic.gauges, scene_.gauges().size());
  maps.trace_seconds = seconds_since(start);
  const auto build_start = std::chrono::steady_clock::now();
  maps.caustic =
      PhotonMap(std::move(caustic.caustic.positions), std::move(caustic.caustic.photons), stop);
  maps.global =
      PhotonMap(std::move(global.global.positions), std::move(global.global.photons), stop);
  maps.build_seconds = seconds_since(build_start);
  return maps;
}

bool nothing_lit_twice(const MapReport& global) {
  constexpr uint64_t enough = 100;  // of the light that arrives less than some percent goes on
  return global.total().arrived >= enough && global.total().stored == 0;
}

std::vector<std::string> LightPass::warnings(const PhotonMaps& maps) const {
  std::vector<std::string> list;
  if (scene_.surface_count() == 0) return list;  // where should they be?
  const auto explain = [&](const char* name, const MapReport& report) {
    const LightCounts total = report.total();
    if (scene_.lights().empty())
      return fmt::format("the {} map is empty: the scene has no light", name);
    return fmt::format(
        "the {} map is empty: of {} photons {} carried nothing, {} left the scene, {} were "
        "absorbed "
        "before a surface that could store them, {} reached the longest path, {} met no specular "
        "object",
        name, total.emitted, total.nothing, total.escaped, total.absorbed, total.too_long,
        total.stopped);
  };
  if (settings_.global_photons > 0 && maps.global.empty() && !nothing_lit_twice(maps.global_report))
    list.push_back(explain("global", maps.global_report));
  if (settings_.caustic_photons > 0 && maps.caustic.empty() && target_count_ > 0)
    list.push_back(explain("caustic", maps.caustic_report));
  if (settings_.volume_photons > 0 && scene_.has_scattering() && maps.volume.empty())
    list.push_back(explain("volume", maps.volume_report));
  return list;
}

}  // namespace kaustik
