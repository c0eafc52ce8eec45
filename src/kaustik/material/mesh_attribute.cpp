#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "kaustik/material/bsdf_kinds.h"

namespace kaustik {
namespace {

/// Colours or numbers that the mesh has. Where they are below zero they count as zero.
class MeshAttributeTexture final : public Texture {
 public:
  MeshAttributeTexture(std::shared_ptr<const SurfaceAttribute> attribute, float scale)
      : attribute_(std::move(attribute)),
        scale_(scale),
        mean_(spectrum_of(attribute_->mean())),
        maximum_(std::max(0.0f, attribute_->maximum() * scale)) {}

  Spectrum eval(const TextureCoordinates& at, const Wavelengths& wavelengths) const override {
    return lanes_from_reflectance(rgb(at), wavelengths);
  }
  float scalar(const TextureCoordinates& at) const override { return luminance_of(rgb(at)); }
  float maximum() const override { return maximum_; }
  Spectrum mean() const override { return mean_; }
  HeightGradient height_gradient(const TextureCoordinates& at) const override {
    const Vec3f weights(luminance_of({1, 0, 0, 0}), luminance_of({0, 1, 0, 0}),
                        luminance_of({0, 0, 1, 0}));
    return {{0, 0}, attribute_->gradient(at.primitive, weights * scale_)};
  }

 private:
  Spectrum rgb(const TextureCoordinates& at) const {
    return spectrum_of(attribute_->at(at.primitive, at.position));
  }
  Spectrum spectrum_of(const Vec3f& value) const {
    const auto positive = [&](float x) { return std::max(0.0f, x * scale_); };
    return spectrum_from_rgb(positive(value.x), positive(value.y), positive(value.z));
  }

  std::shared_ptr<const SurfaceAttribute> attribute_;
  float scale_;
  Spectrum mean_;
  float maximum_;
};

const TypeInfo& mesh_attribute_info() {
  static const TypeInfo info{
      "texture",
      "mesh_attribute",
      "Colours or numbers of a mesh's vertices, linear between them, or of its faces.",
      {required(text_parameter(
           "name", "",
           "Values to show. vertex_color: the colours of an OBJ, PLY or serialized mesh. vertex_… "
           "or face_…: properties of a PLY, named without _x, _y, _z (or 0, 1, 2).")),
       number_parameter("scale", 1, "Factor on the values.").range(0, 1e6)}};
  return info;
}

std::shared_ptr<const Texture> create_mesh_attribute(const TextureInputs& in) {
  const std::string& name = in.arguments.text("name");
  if (!name.starts_with("vertex_") && !name.starts_with("face_"))
    throw Error(ErrorKind::input,
                fmt::format("nothing that a mesh has can be called '{}'", name.substr(0, 40)),
                "names begin with vertex_ or face_, as vertex_color does",
                in.arguments.place_of("name"));
  const auto scale = float(in.arguments.number("scale"));
  auto attribute = in.attribute ? in.attribute(name) : nullptr;
  if (!attribute) return make_constant_texture(SpectralValue(scale));
  return std::make_shared<MeshAttributeTexture>(std::move(attribute), scale);
}

}  // namespace

TextureType mesh_attribute_type() { return {mesh_attribute_info(), create_mesh_attribute, true}; }

}  // namespace kaustik
