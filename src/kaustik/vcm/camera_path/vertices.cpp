#include "kaustik/vcm/camera_path/vertices.h"

#include <cmath>

namespace kaustik {

CameraVertices::CameraVertices(const CameraPathInputs& inputs, const PixelPlan& plan,
                               const LensNumbers& u_lens)
    : in_(inputs), plan_(plan), u_lens_(u_lens) {
  constexpr size_t usual_length = 12;
  vertices_.reserve(usual_length);
}

CameraVertices::CameraVertices(const CameraVertices& stem, const CameraWalk& branch)
    : CameraVertices(stem) {
  here_ = branch.scatterer();
}

PathVertex CameraVertices::next(const Vec3f& position, const Facing& facing) const {
  PathVertex next;
  if (facing.extinction > 0) next.mean_free_path = 1 / facing.extinction;
  if (vertices_.empty()) {
    const CameraConnection connection = in_.scene.camera().connect(position, u_lens_);
    next.pdf_camera = connection.importance * in_.camera_samples *
                      facing.factor(connection.direction) / sqr(connection.distance);
    return next;
  }
  const PathVertex& before = vertices_.back();
  const float pdf = before.delta ? 1.0f : pdf_;
  const float distance_sq = length_sq(position - last_.position);
  next.pdf_camera = pdf * facing.factor(direction_) / distance_sq;
  next.to_previous = last_facing_.factor(direction_) / distance_sq;
  next.spread = in_.weights.spread_after(before.spread, next.pdf_camera, next, before.delta);
  return next;
}

PathVertex CameraVertices::next_in_medium(const Vec3f& position, const Medium& medium) const {
  PathVertex vertex = next(position, {{}, medium.mean_extinction(position)});
  vertex.merge_volume = in_.media.merge_volume(position, medium);
  return vertex;
}

PathVertex CameraVertices::next_infinitely_far() const {
  PathVertex next;
  const PathVertex& before = vertices_.back();
  next.pdf_camera = before.delta ? 1.0f : pdf_;
  next.spread = in_.weights.spread_after(before.spread, next.pdf_camera, next, before.delta);
  return next;
}

void CameraVertices::arrive(const CameraWalk& walk) {
  here_ = walk.scatterer();
  const SurfacePoint& point = here_.point();
  const Facing facing = here_.facing();
  if (all_delta_ && in_.plans && walk.gauge() < 0 && !here_.is_in_medium()) {
    const SurfaceVertex& vertex = *here_.surface();
    if (any(vertex.lobes() & (Lobes::diffuse | Lobes::glossy)))
      plan_ = in_.plans->at(walk.raster(), in_.shrinkage, point.position,
                            vertex.on_front() ? point.ng : -point.ng);
  }
  vertices_.push_back(here_.is_in_medium() ? next_in_medium(point.position, *walk.medium())
                                           : next(point.position, facing));
  last_ = point;
  last_facing_ = facing;
  find_guides();
}

void CameraVertices::find_guides() {
  back_ = {};
  // What goes back along delta events alone nothing else finds.
  if (!in_.scattering || all_delta_ || here_.is_in_medium()) return;
  if (!in_.techniques().needs_light_paths()) return;
  const SurfaceVertex& vertex = *here_.surface();
  const Vec3f& ng = vertex.point().ng;
  for (const bool front : {false, true}) {
    if (front != vertex.on_front() && !vertex.transmits()) continue;
    const ScatterGuide::Place place = in_.scattering->place(vertex, front ? ng : -ng);
    back_[front ? 1 : 0] = {1 - place.guided(), place.pdf(0, here_.wo())};
  }
}

void CameraVertices::leave(const CameraWalk& walk) {
  pdf_ = walk.last_pdf();
  direction_ = walk.ray().direction;
  PathVertex& vertex = vertices_.back();
  vertex.delta = pdf_ == 0;
  if (!vertex.delta && all_delta_) {
    all_delta_ = false;
    first_ = vertices_.size();
    if (!here_.is_in_medium()) glossy_share_ = walk.vertex().values(direction_).glossy_share();
  }
  previous_ = here_.is_in_medium() ? LightQuery(here_.position()) : light_query(walk.vertex());
  if (vertices_.size() < 2 || !in_.techniques().needs_light_paths()) return;
  vertices_[vertices_.size() - 2].pdf_light =
      vertex.delta ? vertex.to_previous : pdf_light_before(direction_);
}

PathHalves CameraVertices::halves() const {
  PathHalves result;
  result.camera = vertices_;
  result.first_merge_area = plan_.counted_area(in_.camera_samples);
  result.first_survival = plan_.counted_survival(glossy_share_);
  result.first_light_samples = float(plan_.light_samples);
  return result;
}

float CameraVertices::pdf_light_before(const Vec3f& wi) const {
  if (vertices_.size() < 2) return 0;
  return pdf_light_before(wi, here_.pdf_reverse(wi, Lobes::all));
}

float CameraVertices::pdf_light_before(const Vec3f& wi, float pdf_reverse) const {
  if (vertices_.size() < 2) return 0;
  const GuidedBack& back = back_[dot(wi, last_.ng) >= 0 ? 1 : 0];
  return (back.unguided * pdf_reverse + back.guided) * vertices_.back().to_previous;
}

LightQuery CameraVertices::weighed_query() const {
  LightQuery query = previous_;
  query.level = vertices_.size() > 1 ? 1 : 0;
  return query;
}

int CameraVertices::light_samples() const {
  return is_at_first() && !here_.is_in_medium() ? plan_.light_samples : 1;
}

float CameraVertices::merge_radius() const {
  return all_delta_ ? plan_.merge_radius() : std::sqrt(in_.merge_radius_sq);
}

}  // namespace kaustik
