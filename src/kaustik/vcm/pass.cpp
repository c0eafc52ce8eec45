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

PathWeights VcmPass::make_weights() const {
  PathWeights::Settings weights;
  weights.techniques = plans_->techniques;
  weights.light_paths =
      float(light_path_count(scene_.film(), pass_.samples_per_pixel, plans_->light_paths));
  weights.connections = float(settings_.connections) / plans_->connectible_per_path;
  weights.merge_area = plans_->pixels.other_area() * sqr(pass_radius(1, pass_.stage()));
  weights.accepted_area = accepted_area(plans_->pixels);
  weights.first_medium_share = 1 / float(pass_.samples_per_pixel);
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
  PathWeights::Settings traced = weights_.settings();
  traced.techniques.splats = traced.techniques.splats && aims.splats;
  traced.techniques.connections = traced.techniques.connections && aims.connections;
  light_ = trace_light_vertices(
      {.scene = scene_,
       .emission = *plans_->guides.emission,
       .weights = PathWeights(traced),
       .components = settings_.components,
       .maximum_events = settings_.maximum_events,
       .light_paths = light_path_count(scene_.film(), pass_.samples_per_pixel, plans_->light_paths),
       .camera_samples = float(pass_.samples_per_pixel),
       .plans = plans_->pixels,
       .shrinkage = shrinkage_,
       .remembered_paths = aims.remembered_paths,
       .media = media_,
       .scattering = plans_->guides.scattering.get(),
       .remembers_scattering = plans_->guides.scattering != nullptr,
       .gauges = gauges_.empty() ? nullptr : &gauges_},
      pass_, Stream::light_path, splats, stop, progress, report);
  if (plans_->techniques.merging) {
    matt_ = MattMerging(light_, weights_, stop);
    tails_ = LightTails(light_, weights_, stop);
  }
  if (plans_->cache.rounds > 0 && aims.cache && !stop.stop_requested()) fill_cache(stop, report);
  connection_scale_ = float(double(light_.connectible.size()) /
                            (double(settings_.connections) * double(light_.connectible_paths())));
}

void VcmPass::fill_cache(const std::stop_token& stop, PassReport& report) {
  focused_ = focused_vertices(light_, stop);
  focused_matt_ = MattMerging(light_, focused_, weights_, stop);
  cache_ = std::make_unique<IndirectCache>(
      GatherInputs{.scene = scene_,
                   .light = light_,
                   .focused = focused_,
                   .merge_radius_sq = weights_.settings().merge_area * inv_pi,
                   .maximum_events = settings_.maximum_events,
                   .shrinkage = shrinkage_},
      pass_, plans_->cache.gather_rays, stop);
  for (int round = 0; round < plans_->cache.rounds && !stop.stop_requested(); ++round)
    cache_->fill_round(stop);
  report.rays += cache_->rays();
  if (cache_->rays_dropped() > 0 && !stop.stop_requested())
    report.warnings.emplace_back(
        "the irradiance cache left out gather rays whose radiance is not finite: the light there "
        "is too dark; look for lights or reflectances that are far too large");
}

bool VcmPass::goes_by_surfaces() const {
  // A meter's pixels show all that lies around: no probe stands for much of that.
  return plans_->techniques.merging && scene_.camera().traits().can_connect;
}

void VcmPass::sample(const Vec2f& raster, Sampler& sampler, SampleSink& sink) const {
  trace_camera_path({.scene = scene_,
                     .emission = *plans_->guides.emission,
                     .weights = weights_,
                     .light = light_,
                     .matt = matt_,
                     .focused_matt = cache_ ? &focused_matt_ : nullptr,
                     .tails = &tails_,
                     .seen = plans_->pixels.seen(),
                     // On average: what all weights go by, so those of all ways of finding a path
                     // still sum to 1 where a pixel gets more or fewer.
                     .camera_samples = float(pass_.samples_per_pixel),
                     .connection_scale = connection_scale_,
                     .merge_radius_sq = weights_.settings().merge_area * inv_pi,
                     .media = media_,
                     .maximum_events = settings_.maximum_events,
                     .roulette_depth = settings_.roulette_depth,
                     .connections = settings_.connections,
                     .scattering = plans_->guides.scattering.get(),
                     .cache = cache_.get(),
                     .plans = goes_by_surfaces() ? &plans_->pixels : nullptr,
                     .shrinkage = shrinkage_,
                     .visibility = settings_.visibility},
                    plans_->pixels.at(raster, shrinkage_), raster, sampler, sink);
}

}  // namespace kaustik
