#include "kaustik/vcm/plan/plans_file.h"

#include <cmath>
#include <cstring>

#include "kaustik/vcm/lessons/radius_learning.h"

namespace kaustik {
namespace {

void write_scattering(ByteWriter& writer, const ScatterGuide* guide) {
  writer.put(uint8_t(guide ? 1 : 0));
  if (!guide) return;
  const ScatterGuide::Parts& parts = guide->parts();
  std::vector<float> balls;
  for (const ScatterGuide::Ball& ball : parts.balls)
    balls.insert(balls.end(), {ball.center.x, ball.center.y, ball.center.z, ball.radius});
  writer.put_array(balls);
  writer.put_array(parts.nodes);
  writer.put_array(parts.cells);
  writer.put_array(parts.shares);
}

std::shared_ptr<const ScatterGuide> read_scattering(ByteReader& reader) {
  if (!reader.get_flag()) return nullptr;
  ScatterGuide::Parts parts;
  const auto balls = reader.get_array<float>();
  for (size_t i = 0; i + 4 <= balls.size(); i += 4)
    parts.balls.push_back({{balls[i], balls[i + 1], balls[i + 2]}, balls[i + 3]});
  parts.nodes = reader.get_array<ScatterGuide::Node>();
  parts.cells = reader.get_array<ScatterGuide::Cell>();
  parts.shares = reader.get_array<ScatterGuide::Share>();
  // Every way down the tree ends at a cell, every share at a ball.
  bool is_sound = parts.nodes.size() >= size_t(ScatterGuide::side_count);
  for (size_t i = 0; i < parts.nodes.size(); ++i) {
    const ScatterGuide::Node& node = parts.nodes[i];
    is_sound = is_sound && (node.axis < 0 ? node.next < parts.cells.size()
                                          : node.axis < 3 && node.next > i &&
                                                uint64_t(node.next) + 1 < parts.nodes.size());
  }
  for (const ScatterGuide::Cell& cell : parts.cells)
    is_sound = is_sound && cell.begin <= cell.end && cell.end <= parts.shares.size();
  for (const ScatterGuide::Share& share : parts.shares)
    is_sound = is_sound && share.ball < parts.balls.size();
  if (!is_sound) reader.damaged("a guide of scattering in it is no tree");
  return std::make_shared<const ScatterGuide>(std::move(parts));
}

void write_pilot(ByteWriter& writer, const VcmPilot* pilot) {
  writer.put(uint8_t(pilot ? 1 : 0));
  if (!pilot) return;
  writer.put_array(pilot->probes);
  writer.put_array(pilot->areas);
  writer.put(pilot->costs);
  writer.put(pilot->light_paths);
  writer.put(pilot->light_share);
  writer.put(uint8_t(pilot->needs_merging ? 1 : 0));
  for (const CacheTrial& trial : pilot->cache_trials) {
    writer.put(uint8_t(trial.served.empty() ? 0 : 1));
    if (trial.served.empty()) continue;
    writer.put_array(trial.served);
    writer.put_array(trial.ray_variance);
    writer.put_array(trial.light_variance);
    writer.put(trial.rays_per_ray);
  }
}

std::shared_ptr<const VcmPilot> read_pilot(ByteReader& reader, size_t probes) {
  if (!reader.get_flag()) return nullptr;
  VcmPilot pilot;
  pilot.probes = reader.get_array<ProbeStatistics>(probes);
  pilot.areas = reader.get_array<float>(probes);
  pilot.costs = reader.get<PassCosts>();
  pilot.light_paths = reader.get<float>();
  pilot.light_share = reader.get<double>();
  if (!(pilot.light_share > 0) || !(pilot.costs.pixels > 0))
    reader.damaged("its pilot has no light paths, or no pixels");
  pilot.needs_merging = reader.get_flag();
  for (CacheTrial& trial : pilot.cache_trials) {
    if (!reader.get_flag()) continue;
    trial.served = reader.get_array<uint8_t>(probes);
    trial.ray_variance = reader.get_array<float>(probes);
    trial.light_variance = reader.get_array<float>(probes);
    trial.rays_per_ray = reader.get<double>();
    for (const auto* variances : {&trial.ray_variance, &trial.light_variance})
      for (const float variance : *variances)
        if (!(variance >= 0)) reader.damaged("a cache in it has a variance below 0");
    if (!(trial.rays_per_ray >= 0)) reader.damaged("filling a cache in it takes less than no rays");
  }
  return std::make_shared<const VcmPilot>(std::move(pilot));
}

}  // namespace

void write_plans(ByteWriter& writer, const VcmPlans& plans) {
  writer.put(plans.samples_per_pixel);
  plans.guides.emission->write(writer);
  write_scattering(writer, plans.guides.scattering.get());
  writer.put(plans.guides.noise_of_guided);
  writer.put(plans.techniques);
  writer.put(plans.light_paths);
  plans.pixels.write(writer);
  plans.media.write(writer);
  write_pilot(writer, plans.pilot.get());
  writer.put(uint64_t(plans.decisions.size()));
  for (const std::string& decision : plans.decisions) writer.put_text(decision);
  writer.put(plans.connectible_per_path);
  writer.put(int32_t(plans.cache.rounds));
  writer.put(int32_t(plans.cache.gather_rays));
}

VcmPlans PlansReader::next() {
  VcmPlans plans;
  plans.samples_per_pixel = reader_.get<uint32_t>();
  plans.guides.emission =
      std::make_shared<const LightPathEmission>(LightPathEmission::read(reader_, plain_));
  plans.guides.scattering = read_scattering(reader_);
  plans.guides.noise_of_guided = reader_.get<double>();
  const auto techniques = reader_.get<std::array<uint8_t, sizeof(Techniques)>>();
  for (const uint8_t flag : techniques)
    if (flag > 1) reader_.damaged("a technique in it is neither on nor off");
  std::memcpy(&plans.techniques, techniques.data(), sizeof(Techniques));
  plans.light_paths = reader_.get<float>();
  if (!seen_) {
    auto seen = settings_.techniques.merging ? std::make_shared<SeenSurfaces>(scene_)
                                             : std::make_shared<SeenSurfaces>();
    uint64_t rays = 0;
    if (plans.techniques.merging && settings_.edges)
      seen->find_edges(scene_, RadiusLearning::widest_widths(), settings_.radius, rays);
    seen_ = std::move(seen);
  }
  plans.pixels = PixelPlans::read(reader_, seen_);
  for (const PixelPlan& plan : plans.pixels.plans())
    if (!(plan.covered > 0 && plan.covered <= 1) || !(plan.merging_in_common >= 1) ||
        !std::isfinite(plan.merging_in_common))
      reader_.damaged("what a block in it shares is out of bounds");
  for (const PixelPlan& plan : plans.pixels.plans())
    if (plan.light_samples < 1 || plan.light_samples > PixelPlan::most_light_samples)
      reader_.damaged("a block in it samples no light, or too many");
  if (const auto& spread = plans.pixels.spread())
    for (const uint32_t count : spread->counts)
      if (count == 0 || count > uint64_t(SampleSpread::most_factor) * plans.samples_per_pixel)
        reader_.damaged("a block in it has no samples, or too many");
  plans.media = MediumDisks::read(reader_, scene_);
  plans.pilot = read_pilot(reader_, seen_->probes().size());
  const auto decisions = reader_.get<uint64_t>();
  for (uint64_t i = 0; i < decisions; ++i) plans.decisions.push_back(reader_.get_text());
  plans.connectible_per_path = reader_.get<float>();
  plans.cache.rounds = reader_.get<int32_t>();
  plans.cache.gather_rays = reader_.get<int32_t>();
  const bool may_have_cache = plans.pilot && settings_.choices.cache != CacheUse::never &&
                              !plans.techniques.splats && !plans.techniques.connections;
  if (plans.cache.rounds < 0 || plans.cache.rounds > IndirectCache::most_rounds ||
      (plans.cache.rounds > 0 && !(may_have_cache && plans.pilot->has_tried(plans.cache.rounds))))
    reader_.damaged("its cache is filled in a number of rounds that was not tried");
  if (plans.cache.gather_rays < IndirectCache::least_gather_rays ||
      plans.cache.gather_rays > IndirectCache::most_gather_rays)
    reader_.damaged("records of its cache have too few gather rays, or too many");
  plans.choices = settings_.choices;
  return plans;
}

}  // namespace kaustik
