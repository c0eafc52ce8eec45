#include "kaustik/vcm/light_path/densities.h"

namespace kaustik {
namespace {

/// Density with which direct light is sampled at a vertex from the point where a light path begins,
/// `distance` away; measure as PathHalves::pdf_next_event.
float next_event_density(const Scene& scene, const LightQuery& query, int light,
                         const SurfacePoint& on_light, const Vec3f& to_light, float distance) {
  const Light& of = *scene.lights()[size_t(light)];
  if (of.traits().is_delta)
    return scene.light_selector().probability(query.reference, query.normal, light);
  if (of.is_infinite()) return direct_light_pdf(scene, query, LightChoice::one, light, to_light);
  return direct_light_pdf(scene, query, LightChoice::one, light, on_light) *
         abs_dot(to_light, of.placed().emitting_normal(on_light)) / sqr(distance);
}

}  // namespace

void begin_light_path(const LightPathStart& start, LightPathUnderWay& path) {
  PathVertex on_light;
  on_light.pdf_light = start.density.endpoint;
  path.vertices.push_back(on_light);
  path.last = {start.emitted.on_surface ? start.emitted.origin.ng : Vec3f(0, 0, 0), 0};
}

PathVertex next_light_vertex(const VcmLightInputs& in, const LightQuery& query,
                             const Facing& facing, const PathState& state, const Vec3f& wo,
                             float distance, LightPathUnderWay& path) {
  std::vector<PathVertex>& vertices = path.vertices;
  const float cosine = facing.factor(wo);
  const float distance_sq = sqr(distance);
  PathVertex next;
  if (facing.extinction > 0) next.mean_free_path = 1 / facing.extinction;
  if (vertices.size() == 1) {
    const Light& light = *in.scene.lights()[size_t(path.start.light)];
    if (light.is_infinite()) {
      next.pdf_light = path.start.density.rest * cosine;
      next.to_previous = light.traits().is_delta ? 0.0f : 1.0f;
    } else {
      next.pdf_light = path.start.density.rest * cosine / distance_sq;
      // Lights that are no surface are never met.
      next.to_previous = light.traits().shape < 0 ? 0.0f : path.last.factor(wo) / distance_sq;
    }
    path.pdf_next_event = next_event_density(in.scene, query, path.start.light,
                                             path.start.emitted.origin, wo, distance);
  } else {
    const bool after_delta = state.pdf_forward == 0;
    vertices.back().delta = after_delta;
    vertices[vertices.size() - 2].pdf_camera =
        (after_delta ? 1.0f : state.pdf_reverse) * vertices.back().to_previous;
    next.pdf_light = (after_delta ? 1.0f : state.pdf_forward) * cosine / distance_sq;
    next.to_previous = path.last.factor(wo) / distance_sq;
  }
  return next;
}

PathVertex next_light_vertex(const VcmLightInputs& in, const LightMediumVertex& at,
                             LightPathUnderWay& path) {
  PathVertex next = next_light_vertex(in, LightQuery(at.position, {0, 0, 0}, 1),
                                      {{0, 0, 0}, at.medium.mean_extinction(at.position)}, at.state,
                                      at.wo, at.distance, path);
  next.merge_volume = in.media.merge_volume(at.position, at.medium);
  return next;
}

/// As the camera's path chooses it: on the side of the surface that the camera sees.
PixelPlan plan_of(const VcmLightInputs& in, const SeenByCamera& seen) {
  const CameraConnection& connection = seen.connection;
  if (!seen.vertex) return in.plans.at(connection.raster, in.shrinkage);
  const Vec3f& ng = seen.vertex->point().ng;
  return in.plans.at(connection.raster, in.shrinkage, seen.vertex->position(),
                     dot(connection.direction, ng) > 0 ? ng : -ng);
}

PathHalves splat_halves(const VcmLightInputs& in, const LightPathUnderWay& path,
                        const SeenByCamera& seen) {
  PathHalves halves;
  halves.light = path.vertices;
  halves.pdf_camera_last =
      seen.connection.importance * in.camera_samples * seen.facing / sqr(seen.connection.distance);
  halves.pdf_camera_before_last = seen.pdf_reverse * path.vertices.back().to_previous;
  halves.pdf_next_event = path.pdf_next_event;
  const PixelPlan plan = plan_of(in, seen);
  halves.first_merge_area = plan.counted_area(in.camera_samples);
  halves.first_survival = plan.counted_survival(seen.glossy_share);
  return halves;
}

}  // namespace kaustik
