#include "kaustik/light/light_kinds.h"

namespace kaustik {
namespace {

/// A colour behind the scene. It is a light only in that rays which leave the scene meet it.
class Background final : public Light {
 public:
  explicit Background(const Spectrum& radiance) : radiance_(radiance) {}

  Spectrum power() const override { return {}; }
  LightBounds bounds() const override {
    LightBounds b;
    b.infinite = true;
    return b;
  }
  bool is_delta() const override { return false; }
  bool is_infinite() const override { return true; }
  bool is_only_seen() const override { return true; }
  Spectrum background(const Vec3f&) const override { return radiance_; }

  float expected_irradiance(const LightQuery&) const override { return 0; }
  LightSample sample_toward(const LightQuery&, const Vec2f&) const override { return {}; }
  EmissionSample sample_emission(const Vec2f&, const Vec2f&) const override {
    EmissionSample nothing;
    nothing.point = free_point({0, 0, 0});
    return nothing;
  }
  float emission_pdf_position(const SurfacePoint&) const override { return 0; }
  float emission_pdf_direction(const SurfacePoint&, const Vec3f&) const override { return 0; }

 private:
  Spectrum radiance_;
};

std::unique_ptr<Light> create_background(const LightInputs& inputs) {
  return std::make_unique<Background>(emission_argument(inputs, "radiance"));
}

}  // namespace

LightType background_light_type() {
  static const TypeInfo info{
      "emitter",
      "background",
      "A colour where the view leaves the scene, also by mirrors and glass; it lights nothing.",
      {color_parameter("radiance", 1, "Radiance that is seen.").in("W/(sr·m²)")}};
  return {info, false, create_background};
}

}  // namespace kaustik
