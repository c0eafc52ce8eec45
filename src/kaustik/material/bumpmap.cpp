#include "kaustik/material/bent_bsdf.h"
#include "kaustik/material/bsdf_kinds.h"

namespace kaustik {
namespace {

/// Blinn's bump mapping: the normal of the surface that the texture's heights would make, were it
/// moved by them along its normal ("Simulation of Wrinkled Surfaces", SIGGRAPH 1978).
class BumpRelief final : public Relief {
 public:
  BumpRelief(std::shared_ptr<const Texture> texture, float scale)
      : texture_(std::move(texture)), scale_(scale) {}

  Vec3f normal(const ReliefPoint& at) const override {
    const HeightGradient gradient = texture_->height_gradient(at.texture);
    const Vec3f in_space =
        at.world_from_shape ? at.world_from_shape->normal(gradient.position) : gradient.position;
    Vec3f slope = in_space + by_uv(at, gradient.uv);
    slope -= at.normal * dot(slope, at.normal);
    const Vec3f bent = at.normal - slope * scale_;
    return is_finite(bent) ? normalize(bent) : at.normal;
  }

 private:
  /// The gradient on the surface of a height that changes with uv by `g`.
  static Vec3f by_uv(const ReliefPoint& at, const Vec2f& g) {
    // The dual basis of the tangents: its vectors tell how u and v change along the surface.
    const Vec3f n = cross(at.dpdu, at.dpdv);
    const float area_sq = length_sq(n);
    if (!(area_sq > 0)) return {0, 0, 0};
    return (cross(at.dpdv, n) * g.x + cross(n, at.dpdu) * g.y) * (1 / area_sq);
  }

  std::shared_ptr<const Texture> texture_;
  float scale_;
};

const TypeInfo& bumpmap_info() {
  static const TypeInfo info{
      "bsdf",
      "bumpmap",
      "Bends the normals of the nested bsdf by the heights of a texture. Silhouettes stay.",
      {optional(number_parameter("texture", 0, "Heights in m. A colour counts by its luminance."))
           .textured(),
       number_parameter("scale", 1, "Factor on the heights.").range(-1e6, 1e6),
       ignored_parameter("flip_invalid_normals", ParameterKind::boolean),
       ignored_parameter("use_shadowing_function", ParameterKind::boolean)}};
  return info;
}

std::shared_ptr<const Bsdf> create_bumpmap(const BsdfInputs& inputs) {
  return make_bent_bsdf(inputs,
                        std::make_unique<BumpRelief>(relief_texture(inputs, "texture"),
                                                     float(inputs.arguments.number("scale"))));
}

}  // namespace

BsdfType bumpmap_type() { return {bumpmap_info(), 1, 1, create_bumpmap}; }

}  // namespace kaustik
