#include "kaustik/light/light_kinds.h"

namespace kaustik {
namespace {

/// A colour behind the scene. It is a light only in that rays which leave the scene meet it.
class Background final : public DistantLight {
 public:
  explicit Background(const SpectralValue& radiance) : radiance_(radiance) {
    traits_.is_only_seen = true;
    traits_.bounds.infinite = true;
  }

  Spectrum background(const Vec3f&, const Wavelengths& wavelengths) const override {
    return radiance_.at(wavelengths);
  }

  float expected_irradiance(const LightQuery&) const override { return 0; }
  LightSample sample_toward(const LightQuery&, const Vec2f&) const override { return {}; }
  float pdf_toward(const LightQuery&, const LightTarget&) const override { return 0; }
  Spectrum emitted(const SurfacePoint&, const Vec3f&, const Wavelengths&) const override {
    return {};
  }
  EmissionSample sample_emission(const Vec2f&, const Vec2f&, const Wavelengths&) const override {
    EmissionSample nothing;
    nothing.point = free_point({0, 0, 0});
    return nothing;
  }
  float emission_pdf_position(const SurfacePoint&) const override { return 0; }
  float emission_pdf_direction(const SurfacePoint&, const Vec3f&) const override { return 0; }
  TravelDirection sample_travel_direction(const Vec2f&) const override { return {}; }

 private:
  SpectralValue radiance_;
};

std::unique_ptr<Light> create_background(const LightInputs& inputs) {
  return std::make_unique<Background>(emission_argument(inputs, "radiance"));
}

}  // namespace

LightType background_light_type() {
  static const TypeInfo info{"emitter",
                             "background",
                             "A colour where the view leaves the scene, also by mirrors and "
                             "through glass. It lights nothing.",
                             {color_parameter("radiance", 1, "Visible radiance.").in("W/(sr·m²)")}};
  return {info, false, create_background};
}

}  // namespace kaustik
