#include "kaustik/photon/emission/emission.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kaustik/base/to_integer.h"
#include "kaustik/photon/emission/aim_light.h"
#include "kaustik/photon/emission/projection_map.h"

namespace kaustik {

namespace {
constexpr size_t max_spheres = 128;
}  // namespace

const Shape* shape_of(const Scene& scene, const Light& light) {
  return light.traits().shape >= 0 ? &scene.tracer().shape(uint32_t(light.traits().shape))
                                   : nullptr;
}

EmissionSampler::EmissionSampler(const Scene& scene) : scene_(&scene) {}

EmissionSampler::EmissionSampler(const Scene& scene, std::vector<AimTarget> targets)
    : scene_(&scene) {
  aim_at(std::move(targets), {});
}

EmissionSampler::EmissionSampler(const Scene& scene, Lobes lobes, int budget, Aim aim)
    : scene_(&scene) {
  std::vector<AimTarget> targets = find_targets(scene, lobes, budget, Aim::boxes);
  target_count_ = targets.size();
  if (aim == Aim::none) return;
  std::vector<AimTarget> seen_by_cells;
  if (aim == Aim::projection_map)
    seen_by_cells = find_targets(scene, lobes, budget, Aim::projection_map);
  aim_at(std::move(targets), seen_by_cells);
}

void EmissionSampler::aim_at(std::vector<AimTarget> targets,
                             const std::vector<AimTarget>& seen_by_cells) {
  aimed_ = true;
  target_count_ = std::max(targets.size(), seen_by_cells.size());
  const Bounds3f scene_bounds = scene_->tracer().bounds();
  std::vector<Bounds3f> boxes;
  for (const AimTarget& target : seen_by_cells) boxes.push_back(target.box);
  std::vector<AimSphere> spheres;
  for (const AimTarget& target : merge_targets(std::move(targets), max_spheres))
    spheres.push_back(bounding_sphere(target, scene_bounds));
  // The more lights, the less is spent on each.
  const double lights = double(std::max<size_t>(1, scene_->lights().size()));
  const int probes = std::clamp(int(4096 / lights), 2, 16);
  const int resolution = std::clamp(int(128 / std::sqrt(lights)), 8, 64);
  for (const auto& light : scene_->lights()) {
    const Shape* shape = shape_of(*scene_, *light);
    const ProjectionInputs inputs{boxes, scene_bounds, resolution, std::max(2, probes / 2)};
    // An environment's planes are as many as its directions: no map could hold them.
    if (boxes.empty() || (light->is_infinite() && !light->traits().is_delta) ||
        light->traits().is_beam())
      lights_.push_back(
          std::make_unique<AimedLight>(*light, shape, AimInputs{spheres, scene_bounds, probes}));
    else if (light->is_infinite())
      lights_.push_back(std::make_unique<ProjectionPlane>(*light, inputs));
    else
      lights_.push_back(std::make_unique<ProjectionMap>(*light, shape, inputs));
  }
}

EmissionSampler::~EmissionSampler() = default;

EmittedRay EmissionSampler::sample(int light, const Vec2f& u_position, const Vec2f& u_direction,
                                   float u_target, const Wavelengths& wavelengths) const {
  EmittedRay emitted =
      aimed_ ? lights_[size_t(light)]->sample(u_position, u_direction, u_target, wavelengths)
             : sample_own(*scene_->lights()[size_t(light)], u_position, u_direction, wavelengths);
  dim(light, emitted, wavelengths);
  return emitted;
}

void EmissionSampler::dim(int light, EmittedRay& emitted, const Wavelengths& wavelengths) const {
  const Medium* medium = scene_->light_medium(light);
  const Light& of = *scene_->lights()[size_t(light)];
  if (!medium || !of.is_infinite() || of.traits().is_beam()) return;
  const Sampler by_segment = Sampler::of(Quadrature::light_medium, 0);
  // It has come through all of the medium that lies behind.
  emitted.flux *= medium->transmittance({emitted.ray.origin, -emitted.ray.direction, infinity},
                                        wavelengths, by_segment);
}

float EmissionSampler::pdf(int light, const SurfacePoint& origin, const Vec3f& direction) const {
  if (aimed_) return lights_[size_t(light)]->pdf(origin, direction);
  return own_pdf(*scene_->lights()[size_t(light)], origin, direction);
}

Parameter aim_parameter() {
  return choice_parameter(
      "aim", "boxes", {"none", "boxes", "projection_map"},
      "How caustic photons are aimed at specular objects: not at all, at spheres around their "
      "boxes, or through the cells of a projection map that show the boxes.");
}

Aim read_aim(const std::string& name) {
  return name == "none" ? Aim::none : name == "boxes" ? Aim::boxes : Aim::projection_map;
}

namespace {

/// Values without what is negative or not finite, scaled to sum 1 (all zero if there is nothing).
std::vector<double> shares(const std::vector<double>& values, size_t count) {
  std::vector<double> result(count, 0.0);
  for (size_t i = 0; i < std::min(count, values.size()); ++i)
    if (std::isfinite(values[i]) && values[i] > 0) result[i] = values[i];
  const double largest = count > 0 ? *std::max_element(result.begin(), result.end()) : 0.0;
  if (!(largest > 0)) return result;
  for (double& r : result) r /= largest;
  const double total = std::accumulate(result.begin(), result.end(), 0.0);
  for (double& r : result) r /= total;
  return result;
}

/// Adds `total` in proportion to `parts` (which sum to 1) to the counts: rounded down, then one
/// more for those with the largest remainders.
void add_by_largest_remainder(uint32_t total, const std::vector<double>& parts,
                              std::vector<uint32_t>& counts) {
  std::vector<std::pair<double, size_t>> remainders;
  uint32_t given = 0;
  for (size_t i = 0; i < parts.size(); ++i) {
    const double exact = parts[i] * double(total);
    const auto whole = to_integer(exact, 0u, total - given);
    counts[i] += whole;
    given += whole;
    if (parts[i] > 0) remainders.emplace_back(exact - double(whole), i);
  }
  std::stable_sort(remainders.begin(), remainders.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  for (size_t k = 0; given < total; ++given, ++k)
    ++counts[remainders[k % remainders.size()].second];
}

}  // namespace

std::vector<uint32_t> share_photons(uint32_t total, const std::vector<double>& arriving,
                                    const std::vector<double>& power) {
  const std::vector<double> by_power = shares(power, power.size());
  std::vector<double> useful = arriving;
  useful.resize(power.size(), 0.0);
  for (size_t i = 0; i < power.size(); ++i)
    if (!(by_power[i] > 0)) useful[i] = 0;
  const std::vector<double> by_arrival = shares(useful, power.size());
  const bool trained =
      std::any_of(by_arrival.begin(), by_arrival.end(), [](double a) { return a > 0; });

  std::vector<uint32_t> counts(power.size(), 0);
  const auto emitting =
      uint32_t(std::count_if(power.begin(), power.end(), [](double p) { return p > 0; }));
  if (emitting == 0) return counts;
  std::vector<double> parts(power.size(), 0.0);
  for (size_t i = 0; i < power.size(); ++i) {
    if (!(power[i] > 0)) continue;
    counts[i] = 1;
    parts[i] = trained ? 0.9 * by_arrival[i] + 0.09 * by_power[i] + 0.01 / emitting
                       : 0.99 * by_power[i] + 0.01 / emitting;
  }
  if (total > emitting) add_by_largest_remainder(total - emitting, parts, counts);
  return counts;
}

}  // namespace kaustik
