#include "kaustik/material/bent_bsdf.h"
#include "kaustik/material/bsdf_kinds.h"

namespace kaustik {
namespace {

/// Normals given by a picture: red, green and blue stand for −1 to 1 along u, across u and along
/// the normal.
class NormalRelief final : public Relief {
 public:
  NormalRelief(std::shared_ptr<const Texture> texture, float strength, bool against_v)
      : texture_(std::move(texture)), strength_(strength), against_v_(against_v) {}

  Vec3f normal(const ReliefPoint& at) const override {
    const Spectrum c = texture_->eval(at.texture, {});  // in RGB mode: vectors, no light
    const Vec3f along_u = at.dpdu - at.normal * dot(at.normal, at.dpdu);
    const float length_u = length(along_u);
    if (!(length_u > 0)) return at.normal;
    const Vec3f x = along_u * (1 / length_u);
    Vec3f y = cross(at.normal, x);
    if (against_v_ && dot(y, at.dpdv) > 0) y = -y;
    const Vec3f n = x * (strength_ * (2 * c[0] - 1)) + y * (strength_ * (2 * c[1] - 1)) +
                    at.normal * std::max(2 * c[2] - 1, 0.0f);
    const float n_length = length(n);
    // Normals that cancel over the footprint leave the surface's own.
    return n_length > 1e-4f ? n * (1 / n_length) : at.normal;
  }

 private:
  std::shared_ptr<const Texture> texture_;
  float strength_;
  bool against_v_;
};

const TypeInfo& normalmap_info() {
  static const TypeInfo info{
      "bsdf",
      "normalmap",
      "Replaces the normals of the nested bsdf by those of a picture.",
      {optional(color_parameter("normalmap", 0.5, "Normals. A bitmap needs raw = true."))
           .textured(),
       number_parameter("strength", 1, "Factor on what is along u and across u.").range(-1e3, 1e3),
       boolean_parameter("against_v", false,
                         "Green leans toward the picture's upper edge also where it lies mirrored "
                         "on the surface, as in glTF; otherwise across u."),
       ignored_parameter("flip_invalid_normals", ParameterKind::boolean),
       ignored_parameter("use_shadowing_function", ParameterKind::boolean)}};
  return info;
}

std::shared_ptr<const Bsdf> create_normalmap(const BsdfInputs& inputs) {
  return make_bent_bsdf(inputs,
                        std::make_unique<NormalRelief>(relief_texture(inputs, "normalmap"),
                                                       float(inputs.arguments.number("strength")),
                                                       inputs.arguments.boolean("against_v")));
}

}  // namespace

BsdfType normalmap_type() { return {normalmap_info(), 1, 1, create_normalmap}; }

}  // namespace kaustik
