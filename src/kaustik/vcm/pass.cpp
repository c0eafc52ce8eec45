#include "kaustik/vcm/pass.h"

#include <cmath>

#include "kaustik/photon/photon_map.h"
#include "kaustik/vcm/camera_path/camera_path.h"
#include "kaustik/vcm/light_pass.h"

namespace kaustik {

VcmPass::VcmPass(const Scene& scene, const VcmSettings& settings,
                 std::shared_ptr<const VcmPlans> plans, const Pass& pass)
    : scene_(scene),
      settings_(settings),
      plans_(std::move(plans)),
      pass_(pass),
      weights_(make_weights()),
      shrinkage_(sqr(pass_radius(1, pass.stage()))),
      media_(plans_->media.shrunk(shrinkage_)) {}

uint32_t VcmPass::light_paths_of_set() const {
  const uint32_t all =
      light_path_count(scene_.film(), pass_.samples_per_pixel, plans_->light_paths);
  const auto sets = uint32_t(pass_.wavelengths.count());
  return (all + sets - 1) / sets;
}

std::vector<const LightVertices*> VcmPass::light_of_sets() const {
  std::vector<const LightVertices*> result;
  for (size_t set = 0; set < pass_.wavelengths.count(); ++set)
    result.push_back(&sets_[set].vertices);
  return result;
}

// Light of each set meets the samples of the same set alone, as if the set were a pass of its own.
PathWeights VcmPass::make_weights() const {
  PathWeights::Settings weights;
  weights.techniques = plans_->techniques;
  weights.light_paths = float(light_paths_of_set());
  weights.connections = float(settings_.connections) / plans_->connectible_per_path;
  weights.merge_area = plans_->pixels.other_area() * sqr(pass_radius(1, pass_.stage()));
  weights.accepted_area = accepted_area(plans_->pixels);
  weights.first_medium_share = 1 / pass_.samples_per_set();
  return PathWeights(weights);
}

GaugeDisks VcmPass::make_gauge_disks(uint64_t& rays) const {
  const Vec2i size = scene_.film().size;
  std::vector<float> radii(scene_.gauges().size());
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const Vec2f raster(float(x) + 0.5f, float(y) + 0.5f);
      if (const int gauge = scene_.camera().gauge_at(raster); gauge >= 0)
        radii[size_t(gauge)] = plans_->pixels.at(raster, shrinkage_).merge_radius();
    }
  constexpr double golden = 0.6180339887498949;
  return {scene_, std::move(radii), float(std::fmod(double(pass_.index) * golden, 1.0)), rays};
}

void VcmPass::trace_light(const LightPathAims& aims, SplatBuffer& splats, std::stop_token stop,
                          const ProgressFunction& progress, PassReport& report) {
  if (!plans_->techniques.needs_light_paths()) return;
  if (plans_->techniques.merging && !scene_.gauges().empty())
    gauges_ = make_gauge_disks(report.rays);
  const size_t sets = pass_.wavelengths.count();
  for (size_t set = 0; set < sets && !stop.stop_requested(); ++set)
    trace_set(set, aims, splats, stop, part_of(progress, uint32_t(set), uint32_t(sets)), report);
}

void VcmPass::trace_set(size_t set, const LightPathAims& aims, SplatBuffer& splats,
                        std::stop_token stop, const ProgressFunction& progress,
                        PassReport& report) {
  LightOfSet& light = sets_[set];
  PathWeights::Settings traced = weights_.settings();
  traced.techniques.splats = traced.techniques.splats && aims.splats;
  traced.techniques.connections = traced.techniques.connections && aims.connections;
  light.vertices =
      trace_light_vertices({.scene = scene_,
                            .emission = *plans_->guides.emission,
                            .weights = PathWeights(traced),
                            .components = settings_.components,
                            .maximum_events = settings_.maximum_events,
                            .light_paths = light_paths_of_set(),
                            .set = set,
                            .camera_samples = pass_.samples_per_set(),
                            .plans = plans_->pixels,
                            .shrinkage = shrinkage_,
                            .remembered_paths = aims.remembered_paths,
                            .media = media_,
                            .scattering = plans_->guides.scattering.get(),
                            .remembers_scattering = plans_->guides.scattering != nullptr,
                            .gauges = gauges_.empty() ? nullptr : &gauges_},
                           pass_, Stream::light_path, splats, stop, progress, report);
  if (plans_->techniques.merging) {
    light.matt = MattMerging(light.vertices, weights_, stop);
    light.tails = LightTails(light.vertices, weights_, stop);
  }
  if (plans_->cache.rounds > 0 && aims.cache && !stop.stop_requested())
    fill_cache(set, stop, report);
  light.connection_scale =
      float(double(light.vertices.connectible.size()) /
            (double(settings_.connections) * double(light.vertices.connectible_paths())));
}

void VcmPass::fill_cache(size_t set, const std::stop_token& stop, PassReport& report) {
  LightOfSet& light = sets_[set];
  light.focused = focused_vertices(light.vertices, stop);
  light.focused_matt = MattMerging(light.vertices, light.focused, weights_, stop);
  // The noise of each set's records is its own, so together they need no more rays.
  const int gather_rays = std::max(IndirectCache::least_gather_rays,
                                   plans_->cache.gather_rays / int(pass_.wavelengths.count()));
  light.cache = std::make_unique<IndirectCache>(
      GatherInputs{.scene = scene_,
                   .light = light.vertices,
                   .focused = light.focused,
                   .merge_radius_sq = weights_.settings().merge_area * inv_pi,
                   .maximum_events = settings_.maximum_events,
                   .shrinkage = shrinkage_},
      pass_, set, gather_rays, stop);
  for (int round = 0; round < plans_->cache.rounds && !stop.stop_requested(); ++round)
    light.cache->fill_round(stop);
  report.rays += light.cache->rays();
  if (light.cache->rays_dropped() > 0 && !stop.stop_requested())
    report.warnings.emplace_back(
        "the irradiance cache left out gather rays whose radiance is not finite: the light there "
        "is too dark; look for lights or reflectances that are far too large");
}

bool VcmPass::goes_by_surfaces() const {
  // A meter's pixels show all that lies around: no probe stands for much of that.
  return plans_->techniques.merging && scene_.camera().traits().can_connect;
}

void VcmPass::sample(const Vec2f& raster, Sampler& sampler, SampleSink& sink) const {
  const LightOfSet& light = sets_[sink.set()];
  trace_camera_path({.scene = scene_,
                     .emission = *plans_->guides.emission,
                     .weights = weights_,
                     .light = light.vertices,
                     .matt = light.matt,
                     .focused_matt = light.cache ? &light.focused_matt : nullptr,
                     .tails = &light.tails,
                     .seen = plans_->pixels.seen(),
                     // On average: what all weights go by, so those of all ways of finding a path
                     // still sum to 1 where a pixel gets more or fewer.
                     .camera_samples = pass_.samples_per_set(),
                     .connection_scale = light.connection_scale,
                     .merge_radius_sq = weights_.settings().merge_area * inv_pi,
                     .media = media_,
                     .maximum_events = settings_.maximum_events,
                     .roulette_depth = settings_.roulette_depth,
                     .connections = settings_.connections,
                     .scattering = plans_->guides.scattering.get(),
                     .cache = light.cache.get(),
                     .plans = goes_by_surfaces() ? &plans_->pixels : nullptr,
                     .shrinkage = shrinkage_,
                     .visibility = settings_.visibility},
                    plans_->pixels.at(raster, shrinkage_), raster, sampler, sink);
}

}  // namespace kaustik
