#include "kaustik/vcm/camera_path/merge_media.h"

#include <algorithm>
#include <cmath>

#include "kaustik/medium/segment_transmittance.h"
#include "kaustik/photon/volume_sight.h"

namespace kaustik {
namespace {

/// Weight of merging with `light`, which lies beside the last vertex of `camera`.
float merge_weight(const CameraPathInputs& in, PathHalves path, const MergeableMediumVertex& light,
                   float phase, float phase_back) {
  const PathVertex* before = in.light.vertices.data() + light.path;
  path.light = {before, light.before};
  path.pdf_light_last = light.pdf_light;
  path.pdf_light_before_last = phase_back * path.camera.back().to_previous;
  path.pdf_camera_last = phase * light.to_previous;
  if (light.before >= 2) path.pdf_camera_before_last = before[light.before - 2].pdf_camera;
  path.pdf_next_event = light.pdf_next_event;
  return in.weights.merge(path);
}

}  // namespace

float MediumMerging::merging_length() const {
  const PathWeights::Settings& settings = in_.weights.settings();
  if (!settings.techniques.merging) return 0;
  if (vertices_.is_at_first()) return infinity;
  const float spread = vertices_.list().back().spread;
  if (vertices_.list().back().delta) return spread >= settings.least_spread ? infinity : 0.0f;
  if (!(settings.least_spread > 0)) return infinity;
  // Across the segment its density is pdf / length².
  if (spread < settings.least_spread) return 0;
  return std::sqrt(spread * vertices_.pdf_of_way() * settings.accepted_area /
                   settings.least_spread);
}

Spectrum MediumMerging::radiance(const Ray& ray, float length, const Medium& medium,
                                 const Wavelengths& wavelengths, const Sampler& sampler,
                                 const Work& work) const {
  Spectrum sum;
  const float merging = std::min(length, merging_length());
  if (in_.light.in_media.empty() || !(merging > 0)) return sum;
  const PhaseFunction& phase_function = medium.phase();
  const Vec3f wo = -ray.direction;
  const auto count = float(in_.light.path_count);
  const auto parts = work.scratch.list<VolumePart>();
  // All vertices before have been left by an event.
  const auto events = int(vertices_.list().size());
  const auto path = work.scratch.list<PathVertex>();
  path->assign(vertices_.list().begin(), vertices_.list().end());
  path->emplace_back();
  PathHalves halves = vertices_.halves();
  halves.camera = *path;
  SegmentTransmittance left(medium, {ray.origin, ray.direction, merging}, wavelengths, sampler,
                            work.scratch);
  in_.light.in_media.discs.visit_met(ray, merging, [&](size_t i, float along, float distance_sq) {
    const MergeableMediumVertex& light = in_.light.in_media.data[i];
    if (!light.medium->is_like(medium) || events + int(light.before) > in_.maximum_events) return;
    const Vec3f position = ray.origin + ray.direction * along;
    const float radius_sq = sqr(in_.light.in_media.discs.radius(i));
    const Vec3f wi = light.direction.unpack();
    const float phase = phase_function.eval(wo, wi);
    path->back() = vertices_.next_in_medium(position, medium);
    const float weight = merge_weight(in_, halves, light, phase, phase_function.eval(wi, wo));
    const float kernel = 2 * inv_pi * (1 - distance_sq / radius_sq) / radius_sq;
    parts->push_back(
        {i, position, light.flux.spectrum() * left.to(along) * (kernel * phase * weight / count)});
    sum += parts->back().light;
  });
  if (!in_.visibility || sum.is_zero()) return sum;
  return visible_from_segment(in_.scene, in_.light.in_media.discs, *parts, sum,
                              sampler.fork(Fork::medium_merge_sight).next_1d(), work.rays);
}

}  // namespace kaustik
