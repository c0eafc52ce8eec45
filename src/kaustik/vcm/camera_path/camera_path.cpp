#include "kaustik/vcm/camera_path/camera_path.h"

namespace kaustik {

CameraPath::CameraPath(const CameraPathInputs& inputs, const PixelPlan& plan, const Vec2f& raster,
                       Sampler& sampler, SampleSink& sink)
    : in_(inputs),
      walk_(inputs.scene, raster, sampler, sink),
      vertices_(inputs, plan, walk_.u_lens()),
      weights_(inputs, vertices_) {}

CameraPath::CameraPath(const CameraPath& stem, Sampler& sampler)
    : in_(stem.in_),
      walk_(stem.walk_, sampler),
      vertices_(stem.vertices_, walk_),
      weights_(in_, vertices_) {}

CameraWalk::Arrival CameraPath::move(bool scatters_in_media, LightWeights* weights) {
  if (!weights) weights = &weights_;
  const bool had_roulette = vertices_.has_roulette_at_first();
  CameraWalk::Arrival arrival = CameraWalk::Arrival::nothing;
  if (scatters_in_media) {
    const MediumMerging merging(in_, vertices_);
    arrival = walk_.fly(in_.techniques().merging ? &merging : nullptr, weights);
  } else if (walk_.advance(nullptr, weights)) {
    arrival = CameraWalk::Arrival::surface;
  }
  if (arrival == CameraWalk::Arrival::nothing) return arrival;
  if (had_roulette) walk_.has_survived(vertices_.survival());
  return arrival;
}

void CameraPath::add_direct_light(LightWeights* weights) {
  if (!weights) weights = &weights_;
  if (vertices_.is_in_medium())
    walk_.add_medium_light(weights);
  else
    walk_.add_direct_light(1, 1, {.samples = vertices_.light_samples()}, {.weights = weights});
}

void CameraPath::ask_cache() {
  if (!IndirectCache::is_for(walk_, in_.maximum_events) || !walk_.wants(Component::indirect))
    return;
  Spectrum radiance;
  if (!in_.cache->reflected(walk_, radiance)) return;
  walk_.add(Component::indirect, radiance);
  walk_.leave_out(Component::indirect);
}

bool CameraPath::may_end_at_lamp() const {
  return in_.scene.has_scattering() ||
         (in_.techniques().unidirectional && in_.scene.has_lights_to_meet());
}

bool CameraPath::survives_first(float u) {
  if (!vertices_.has_roulette_at_first() || u < vertices_.survival()) return true;
  walk_.meet_lamps_only();
  return may_end_at_lamp();
}

}  // namespace kaustik
