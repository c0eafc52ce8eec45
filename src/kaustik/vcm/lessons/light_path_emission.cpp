#include "kaustik/vcm/lessons/light_path_emission.h"

#include <algorithm>

#include "kaustik/base/parallel.h"

namespace kaustik {
namespace {

/// Share of the rays that is aimed at specular objects where there are any.
constexpr float share_for_caustics = 0.5f;

/// Share of the rays that search.
constexpr float search_share = 0.5f;

/// Share of the light paths that all lights have alike, whatever their power: the brightest need
/// not be the one that is seen.
constexpr double even_share = 0.1;

/// Before they are made to sum to 1.
constexpr double least_chance = 0x1p-22;

/// Aimed rays by which it is told that a light has none: of so many.
constexpr uint32_t aim_probes = 512;

/// A number below `share`, or not: made uniform again.
bool takes(float& u, float share) {
  const bool is_below = u < share;
  u = is_below ? u / share : (u - share) / (1 - share);
  u = std::min(u, one_minus_epsilon);
  return is_below;
}

}  // namespace

LightPathEmission::LightPathEmission(const Scene& scene, Aim aim)
    : scene_(&scene),
      own_(std::make_shared<const EmissionSampler>(scene)),
      aimed_(std::make_shared<const EmissionSampler>(scene, Lobes::specular, default_target_budget,
                                                     aim)) {
  double total = 0, emitting = 0;
  for (const auto& light : scene.lights()) {
    total += double(light->traits().power.sum());
    emitting += light->traits().power.sum() > 0 ? 1 : 0;
  }
  std::vector<double> chances;
  for (const auto& light : scene.lights()) {
    const double power = double(light->traits().power.sum());
    chances.push_back(power > 0 ? (1 - even_share) * power / total + even_share / emitting : 0.0);
  }
  set_chances(chances);
  const bool aims = aimed_->aimed() && aimed_->target_count() > 0;
  aimed_shares_.resize(scene.lights().size());
  if (!aims) return;
  parallel_blocks(aimed_shares_.size(), 16, [&](size_t begin, size_t end, size_t) {
    for (size_t i = begin; i < end; ++i)
      aimed_shares_[i] = has_aimed_rays(int(i)) ? share_for_caustics : 0.0f;
  });
}

/// Bounds let a light aim at what it can't shine at, such as what is behind it.
bool LightPathEmission::has_aimed_rays(int light) const {
  for (uint32_t i = 0; i < aim_probes; ++i) {
    Sampler sampler = Sampler::at(0, 0, Stream::aim_probe, uint64_t(light), i);
    const Vec2f u_position = sampler.next_2d(), u_direction = sampler.next_2d();
    const float u_target = sampler.next_1d();
    if (!aimed_->sample(light, u_position, u_direction, u_target, {}).flux.is_zero()) return true;
  }
  return false;
}

LightPathEmission::LightPathEmission(const LightPathEmission& plain,
                                     const std::vector<Guide>& guides)
    : scene_(plain.scene_), own_(plain.own_), aimed_(plain.aimed_), guides_(guides) {
  std::vector<double> chances;
  for (const Guide& guide : guides) {
    chances.push_back(double(guide.chance));
    aimed_shares_.push_back(guide.aimed);
  }
  set_chances(chances);
}

LightPathEmission::LightPathEmission(const LightPathEmission& plain, std::vector<AimTarget> targets)
    : LightPathEmission(plain) {
  if (!targets.empty())
    searching_ = std::make_shared<const EmissionSampler>(*scene_, std::move(targets));
}

void LightPathEmission::set_chances(const std::vector<double>& chances) {
  // None may vanish in the rounding of the sums.
  double sum = 0, total = 0;
  for (const double chance : chances) total += chance > 0 ? chance + least_chance : 0;
  for (const double chance : chances) {
    sum += chance > 0 ? (chance + least_chance) / total : 0;
    const float before = cumulative_.empty() ? 0.0f : cumulative_.back();
    cumulative_.push_back(float(sum));
    // The chance that rounded sums give it.
    chance_.push_back(cumulative_.back() - before);
  }
}

EmittedRay LightPathEmission::sample_plain(int light, const Vec2f& u_position,
                                           const Vec2f& u_direction, float u_choice,
                                           const Wavelengths& wavelengths) const {
  if (searching_ && takes(u_choice, search_share))
    return searching_->sample(light, u_position, u_direction, u_choice, wavelengths);
  const bool aims = takes(u_choice, aimed_shares_[size_t(light)]);
  return (aims ? *aimed_ : *own_).sample(light, u_position, u_direction, u_choice, wavelengths);
}

LightPathStart LightPathEmission::sample(Sampler& sampler, const Wavelengths& wavelengths) const {
  LightPathStart start;
  const Vec2f u_position = sampler.next_2d(), u_direction = sampler.next_2d();
  Vec2f u = sampler.next_2d();
  const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), u.x);
  const auto light = size_t(found - cumulative_.begin());
  if (light >= chance_.size() || !(chance_[light] > 0)) return start;
  EmittedRay& emitted = start.emitted;
  if (!guides_.empty() && guides_[light].share > 0 && takes(u.y, guides_[light].share)) {
    emitted = guides_[light].rays->sample(u_position, u_direction, u.y, wavelengths);
    own_->dim(int(light), emitted, wavelengths);
  } else {
    emitted = sample_plain(int(light), u_position, u_direction, u.y, wavelengths);
  }
  if (emitted.flux.is_zero()) return start;
  start.light = int(light);
  start.density = density(start.light, emitted.origin, emitted.ray.direction);
  const float joint = start.density.endpoint * start.density.rest;
  emitted.flux *= joint > 0 ? emitted.pdf_position * emitted.pdf_direction / joint : 0.0f;
  return start;
}

EmissionDensity LightPathEmission::pdf(int light, const SurfacePoint& origin,
                                       const Vec3f& direction) const {
  if (!(chance_[size_t(light)] > 0)) return {};
  return density(light, origin, direction);
}

size_t LightPathEmission::guided_lights() const {
  return size_t(std::count_if(guides_.begin(), guides_.end(),
                              [](const Guide& guide) { return guide.share > 0; }));
}

float LightPathEmission::own_pdf(int light, const SurfacePoint& origin,
                                 const Vec3f& direction) const {
  return own_->pdf(light, origin, direction);
}

float LightPathEmission::plain_pdf(int light, const SurfacePoint& origin,
                                   const Vec3f& direction) const {
  const float aimed = aimed_shares_[size_t(light)];
  float joint = (1 - aimed) * own_->pdf(light, origin, direction);
  if (aimed > 0) joint += aimed * aimed_->pdf(light, origin, direction);
  if (searching_) joint += search_share * (searching_->pdf(light, origin, direction) - joint);
  return joint;
}

float LightPathEmission::pdf_of_chosen(int light, float plain, const GuideMap::Place& place) const {
  if (guides_.empty() || !(guides_[size_t(light)].share > 0)) return plain;
  const Guide& guide = guides_[size_t(light)];
  return plain + guide.share * (guide.rays->pdf(place) - plain);
}

EmissionDensity LightPathEmission::density(int light, const SurfacePoint& origin,
                                           const Vec3f& direction) const {
  const Light& of = *scene_->lights()[size_t(light)];
  float joint = plain_pdf(light, origin, direction);
  if (!guides_.empty() && guides_[size_t(light)].share > 0) {
    const Guide& guide = guides_[size_t(light)];
    joint += guide.share * (guide.rays->pdf(origin, direction) - joint);
  }
  EmissionDensity result;
  if (of.traits().is_delta)
    result.endpoint = 1;
  else if (of.is_infinite())
    result.endpoint = of.emission_pdf_direction(origin, direction);
  else
    result.endpoint = of.emission_pdf_position(origin);
  if (result.endpoint > 0) result.rest = chance_[size_t(light)] * joint / result.endpoint;
  return result;
}

void LightPathEmission::write(ByteWriter& writer) const {
  writer.put(uint64_t(guides_.size()));
  for (const Guide& guide : guides_) {
    writer.put(guide.chance);
    writer.put(guide.share);
    writer.put(guide.aimed);
    writer.put(uint8_t(guide.rays ? 1 : 0));
    if (guide.rays) guide.rays->square().write(writer);
  }
}

LightPathEmission LightPathEmission::read(ByteReader& reader, const LightPathEmission& plain) {
  const Scene& scene = plain.scene();
  const auto count = reader.get<uint64_t>();
  if (count == 0) return plain;
  if (count != scene.lights().size()) reader.damaged("it is of another number of lights");
  std::vector<Guide> guides(count);
  for (size_t i = 0; i < count; ++i) {
    guides[i].chance = reader.get<float>();
    guides[i].share = reader.get<float>();
    guides[i].aimed = reader.get<float>();
    for (const float chance : {guides[i].chance, guides[i].share, guides[i].aimed})
      if (!(chance >= 0 && chance <= 1)) reader.damaged("a chance in it is none");
    if (guides[i].aimed > plain.aimed_share(int(i)))
      reader.damaged("rays of a light in it are aimed at nothing");
    if (!reader.get_flag()) {
      if (guides[i].share > 0) reader.damaged("a light in it has no guide");
      continue;
    }
    const Light& light = *scene.lights()[i];
    guides[i].rays = std::make_shared<const GuidedLight>(
        std::make_shared<const GuideMap>(light, shape_of(scene, light), scene.tracer().bounds()),
        GuideSquare::read(reader));
  }
  return {plain, guides};
}

}  // namespace kaustik
