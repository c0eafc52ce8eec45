#include "kaustik/photon/emission/projection_map.h"

#include <algorithm>

#include "kaustik/base/sampler.h"
#include "kaustik/base/to_integer.h"

namespace kaustik {
namespace {

/// Everything that may be seen of a box from points of `place`, as a box seen from one point.
Bounds3f seen_from(const Bounds3f& box, const Bounds3f& place, const Bounds3f& scene_bounds) {
  float coordinates = std::max(max_abs(box.min), max_abs(box.max));
  if (!scene_bounds.isEmpty())
    coordinates = std::max({coordinates, max_abs(scene_bounds.min), max_abs(scene_bounds.max)});
  const Vec3f rounding(2e-6f * coordinates);
  return {box.min - place.max - rounding, box.max - place.min + rounding};
}

std::vector<Bounds3f> seen_boxes(const Light& light, const ProjectionInputs& inputs) {
  const Bounds3f place = light.traits().bounds.position;
  std::vector<Bounds3f> result;
  for (const Bounds3f& box : inputs.boxes)
    if (!box.isEmpty()) result.push_back(seen_from(box, place, inputs.scene_bounds));
  return result;
}

/// Whether bounds prove that the light emits nothing into the cell.
bool is_dark(const LightBounds& bounds, const DirectionCells::Cell& cell) {
  const float to_axis = std::acos(std::clamp(dot(cell.center, bounds.axis), -1.0f, 1.0f));
  const float radius = std::acos(std::clamp(cell.cos_radius, -1.0f, 1.0f));
  return to_axis - radius > std::acos(std::clamp(bounds.cos_angle, -1.0f, 1.0f)) + 1e-3f;
}

}  // namespace

ProjectionMap::ProjectionMap(const Light& light, const Shape* shape, const ProjectionInputs& inputs)
    : light_(&light),
      on_surface_(shape != nullptr),
      origins_(light, shape),
      cells_(seen_boxes(light, inputs), inputs.resolution) {
  // What the light emits along the middle of a cell, W/sr, by a few origins; with a floor, since
  // probes prove nothing.
  const auto intensity = [&](const Vec3f& direction) {
    double sum = 0;
    for (int k = 0; k < inputs.probes; ++k) {
      SurfacePoint origin;
      float density = 0;
      const Vec2f u = Sampler::of(Quadrature::aim_cell, uint32_t(k)).next_2d();
      if (!origins_.sample(direction, u, origin, density)) continue;
      const float cosine = on_surface_ ? std::max(dot(origin.ng, direction), 0.0f) : 1.0f;
      sum += double(light_->emitted(origin, direction, {}).max_lane() * (cosine / density));
    }
    return sum / inputs.probes;
  };
  double peak = 0;
  cells_.set_weights([&](const DirectionCells::Cell& cell) {
    peak = std::max(peak, intensity(cell.center));
    return 1.0;
  });
  const LightBounds bounds = light.traits().bounds;
  // Where the probes find nothing at all the light may still have a pattern that they miss.
  const double floor = peak > 0 ? 0.05 * peak : 1.0;
  const bool shines = light.traits().power.max_lane() > 0;
  dark_ = !shines || !cells_.set_weights([&](const DirectionCells::Cell& cell) {
    if (is_dark(bounds, cell)) return 0.0;
    return std::max(intensity(cell.center), floor) * double(cell.solid_angle);
  });
  own_ = !dark_ && own_serves_as_well(
                       light, [this](const auto& origin, const auto& d) { return pdf(origin, d); },
                       inputs.probes * 32);
}

float ProjectionMap::pdf(const SurfacePoint& origin, const Vec3f& direction) const {
  if (dark_) return 0;
  if (own_) return own_pdf(*light_, origin, direction);
  return cells_.pdf(direction) * origins_.pdf(origin, direction);
}

EmittedRay ProjectionMap::sample(const Vec2f& u_position, const Vec2f& u_direction, float u_target,
                                 const Wavelengths& wavelengths) const {
  if (own_) return sample_own(*light_, u_position, u_direction, wavelengths);
  if (dark_) return no_ray();
  const Vec3f direction = cells_.sample(u_target, u_direction);
  return origins_.ray(direction, cells_.pdf(direction), u_position, wavelengths);
}

ProjectionPlane::ProjectionPlane(const Light& light, const ProjectionInputs& inputs)
    : light_(&light), resolution_(4 * inputs.resolution) {
  direction_ = light.distant().sample_travel_direction({0.5f, 0.5f}).direction;
  frame_ = Frame(direction_);
  if (inputs.boxes.empty()) return;
  // Boxes as rectangles of the plane.
  std::vector<Bounds3f> flat;
  Bounds3f all;
  const Bounds3f nowhere(Vec3f(0, 0, 0));
  for (const Bounds3f& box : inputs.boxes) {
    const Bounds3f wide = seen_from(box, nowhere, inputs.scene_bounds);
    Bounds3f rectangle;
    for (int corner = 0; corner < 8; ++corner)
      rectangle.extendBy(frame_.to_local(Vec3f(corner & 1 ? wide.max.x : wide.min.x,
                                               corner & 2 ? wide.max.y : wide.min.y,
                                               corner & 4 ? wide.max.z : wide.min.z)));
    flat.push_back(rectangle);
    all.extendBy(rectangle);
  }
  corner_ = {all.min.x, all.min.y};
  step_ = Vec2f(all.max.x - all.min.x, all.max.y - all.min.y) * (1.0f / float(resolution_));
  if (!(step_.x > 0 && step_.y > 0)) return;
  occupied_.assign(size_t(resolution_) * size_t(resolution_), false);
  const auto cell = [&](float place, int axis) {
    return to_integer((place - corner_[axis]) / step_[axis], 0, resolution_ - 1);
  };
  for (const Bounds3f& box : flat)
    for (int y = cell(box.min.y, 1); y <= cell(box.max.y, 1); ++y)
      for (int x = cell(box.min.x, 0); x <= cell(box.max.x, 0); ++x)
        occupied_[size_t(y) * size_t(resolution_) + size_t(x)] = true;
  for (size_t i = 0; i < occupied_.size(); ++i)
    if (occupied_[i]) list_.push_back(uint32_t(i));
  const Vec3f middle = center(inputs.scene_bounds);
  start_ = dot(middle, direction_) - 1.001f * bounding_radius(inputs.scene_bounds);
}

float ProjectionPlane::pdf(const SurfacePoint& origin, const Vec3f& direction) const {
  if (list_.empty()) return 0;
  const Vec3f local = frame_.to_local(origin.position);
  const float x = (local.x - corner_.x) / step_.x, y = (local.y - corner_.y) / step_.y;
  if (!(x >= 0 && y >= 0 && x < float(resolution_) && y < float(resolution_))) return 0;
  if (!occupied_[size_t(y) * size_t(resolution_) + size_t(x)]) return 0;
  return light_->emission_pdf_direction(origin, direction) /
         (float(list_.size()) * step_.x * step_.y);
}

EmittedRay ProjectionPlane::sample(const Vec2f& u_position, const Vec2f&, float u_target,
                                   const Wavelengths& wavelengths) const {
  EmittedRay result = no_ray();
  if (list_.empty()) return result;
  const size_t i = to_integer(u_target * float(list_.size()), size_t(0), list_.size() - 1);
  const int x = int(list_[i]) % resolution_, y = int(list_[i]) / resolution_;
  const Vec3f local(corner_.x + (float(x) + u_position.x) * step_.x,
                    corner_.y + (float(y) + u_position.y) * step_.y, start_);
  result.origin.position = frame_.to_world(local);
  result.ray = {result.origin.position, direction_};
  result.pdf_position = 1.0f / (float(list_.size()) * step_.x * step_.y);
  result.pdf_direction = 1;
  result.flux =
      light_->emitted(result.origin, direction_, wavelengths) * (1.0f / result.pdf_position);
  return result;
}

}  // namespace kaustik
