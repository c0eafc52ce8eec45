#include "kaustik/material/bsdf_kinds.h"
#include "kaustik/material/noise.h"
#include "kaustik/material/procedural_parameters.h"
#include "kaustik/material/space_transform.h"

namespace kaustik {
namespace {

/// Clouds between two colours; as a relief, rough ground.
class NoiseTexture final : public Texture {
 public:
  explicit NoiseTexture(const Arguments& arguments)
      : color0_(color_argument(arguments, "color0")),
        color1_(color_argument(arguments, "color1")),
        frequency_(float(1 / arguments.number("scale"))),
        amplitude_(float(arguments.number("amplitude"))),
        noise_{int(arguments.integer("octaves")), float(arguments.number("roughness")),
               uint32_t(arguments.integer("seed"))},
        space_(arguments.transform("to_world")) {}

  Spectrum eval(const TextureCoordinates& at, const Wavelengths& wavelengths) const override {
    return mixed(color0_.at(wavelengths), color1_.at(wavelengths), 0.5f + 0.8f * noise(at).value);
  }
  float maximum() const override {
    return std::max(color0_.rgb().max_lane(), color1_.rgb().max_lane());
  }
  /// Exact: the noise is symmetrical, and so is what it is cut off at.
  Spectrum mean() const override { return (color0_.rgb() + color1_.rgb()) * 0.5f; }
  HeightGradient height_gradient(const TextureCoordinates& at) const override {
    return {{0, 0}, space_.gradient(noise(at).gradient * (amplitude_ * frequency_))};
  }

 private:
  NoiseValue noise(const TextureCoordinates& at) const {
    return noise_(space_.point(at) * frequency_, space_.width(at) * frequency_);
  }

  SpectralValue color0_, color1_;
  float frequency_, amplitude_;
  FractalNoise noise_;
  SpaceTransform space_;
};

const TypeInfo& noise_info() {
  static const TypeInfo info{
      "texture",
      "noise",
      "Clouds of two colours in space. As a bump map it is rough ground.",
      {color_parameter("color0", 0, "Colour where the noise is low.").range(0, 1),
       color_parameter("color1", 1, "Colour where the noise is high.").range(0, 1),
       number_parameter("scale", 0.1, "Size of the largest clouds.").range(1e-6, 1e6).in("m"),
       integer_parameter("octaves", 6, "Levels of detail, each twice as fine.").range(1, 16),
       number_parameter("roughness", 0.5, "Strength of a level relative to the previous one.")
           .range(0, 1),
       number_parameter("amplitude", 0.002, "Height of the relief, in bump maps.")
           .range(0, 1e6)
           .in("m"),
       seed_parameter(), texture_to_world_parameter()}};
  return info;
}

std::shared_ptr<const Texture> create_noise(const TextureInputs& in) {
  return std::make_shared<NoiseTexture>(in.arguments);
}

}  // namespace

TextureType noise_type() { return {noise_info(), create_noise}; }

}  // namespace kaustik
