#include "kaustik/material/bsdf_kinds.h"
#include "kaustik/material/noise.h"
#include "kaustik/material/procedural_parameters.h"
#include "kaustik/material/space_transform.h"

namespace kaustik {
namespace {

/// Polished stone: clouds, and veins where warped noise crosses zero, thick ones and finer ones
/// between them. It has no relief.
class Marble final : public Texture {
 public:
  explicit Marble(const Arguments& arguments)
      : ground_(color_argument(arguments, "color0")),
        vein_(color_argument(arguments, "color1")),
        frequency_(float(1 / arguments.number("scale"))),
        contrast_(float(arguments.number("contrast"))),
        seed_(uint32_t(arguments.integer("seed"))),
        space_(arguments.transform("to_world")),
        mean_(sampled_mean(*this, float(16 * arguments.number("scale")))) {}

  Spectrum eval(const TextureCoordinates& at, const Wavelengths& wavelengths) const override {
    return mixed(
        ground_.at(wavelengths), vein_.at(wavelengths),
        contrast_ * darkness(space_.point(at) * frequency_, space_.width(at) * frequency_));
  }
  float maximum() const override {
    return std::max(ground_.rgb().max_lane(), vein_.rgb().max_lane());
  }
  Spectrum mean() const override { return mean_; }
  HeightGradient height_gradient(const TextureCoordinates&) const override { return {}; }

 private:
  /// The same point, pushed about by noise.
  Vec3f warped(const Vec3f& p, float width, float strength, uint32_t seed) const {
    return p + FractalNoise{4, 0.55f, seed}.vector(p, width) * strength;
  }
  /// 1 in the middle of a vein of relative width `thickness`; as the footprint grows the vein gets
  /// wider and paler, so that its mean stays: in the end as wide as the noise has values, whose
  /// density at 0 is about 1.6.
  static float vein(float noise, float thickness, float width) {
    constexpr float slope = 1.5f, widest = 0.31f;
    const float blurred = std::min(std::hypot(thickness, 0.5f * slope * width), widest);
    const float value = noise * noise_visibility(width);
    return thickness / blurred * std::exp(-std::fabs(value) / blurred);
  }
  float darkness(const Vec3f& p, float width) const {
    const float clouds =
        0.5f + 0.9f * FractalNoise{5, 0.55f, seed_ + 11}.value(p * 0.7f, 0.7f * width);
    const Vec3f bent = warped(p * 0.8f, 0.8f * width, 1.1f, seed_ + 23);
    // Veins come in groups: where a slow noise is low there are none.
    const float groups = std::clamp(
        0.5f + 1.8f * noise_visibility(0.45f * width) * gradient_noise_value(p * 0.45f, seed_ + 37),
        0.0f, 1.0f);
    const float main = vein(gradient_noise_value(bent * 0.9f, seed_ + 41), 0.035f, width);
    const Vec3f fine_bent = warped(p * 2.3f, 2.3f * width, 0.9f, seed_ + 53);
    const float fine =
        vein(gradient_noise_value(fine_bent * 1.1f, seed_ + 61), 0.03f, 2.5f * width);
    const float crystals = FractalNoise{3, 0.7f, seed_ + 71}.value(p * 60.0f, 60 * width);
    return 0.16f * std::clamp(clouds, 0.0f, 1.0f) + 0.75f * main * (0.25f + 0.75f * groups) +
           0.35f * fine * groups + 0.05f * crystals;
  }

  SpectralValue ground_, vein_;
  float frequency_, contrast_;
  uint32_t seed_;
  SpaceTransform space_;
  Spectrum mean_;
};

const TypeInfo& marble_info() {
  static const TypeInfo info{
      "texture",
      "marble",
      "Polished marble with veins, in space: it goes through solids.",
      {texture_color("color0", {0.80, 0.78, 0.74}, "Colour of the stone."),
       texture_color("color1", {0.16, 0.17, 0.18}, "Colour of the veins."),
       number_parameter("scale", 0.4, "Distance between large veins.").range(1e-6, 1e6).in("m"),
       number_parameter("contrast", 1, "Strength of veins and clouds.").range(0, 1),
       seed_parameter(), texture_to_world_parameter()}};
  return info;
}

std::shared_ptr<const Texture> create_marble(const Arguments& arguments, PictureReader&) {
  return std::make_shared<Marble>(arguments);
}

}  // namespace

TextureType marble_type() { return {marble_info(), create_marble}; }

}  // namespace kaustik
