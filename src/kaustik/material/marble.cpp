#include <array>

#include "kaustik/material/bsdf_kinds.h"
#include "kaustik/material/noise.h"
#include "kaustik/material/procedural_parameters.h"
#include "kaustik/material/space_transform.h"

namespace kaustik {
namespace {

/// 1 in the middle of a vein, where noise is 0. As the footprint grows the vein gets wider and
/// paler, in the end as wide as the noise has values; its mean over all noise stays.
class Vein {
 public:
  /// Half as wide as that in units of the noise.
  explicit Vein(float thickness) : thickness_(thickness) {
    mean_ = blurred_mean(0);
    for (int i = 0; i < nodes; ++i)
      corrections_[size_t(i)] = mean_ / blurred_mean(widest * sqr(float(i) / (nodes - 1)));
  }
  float mean() const { return mean_; }
  float operator()(float noise, float width) const {
    const float at = (nodes - 1) * std::sqrt(std::min(width / widest, 1.0f));
    const auto i = std::min(size_t(at), size_t(nodes - 2));
    const float correction =
        corrections_[i] + (at - float(i)) * (corrections_[i + 1] - corrections_[i]);
    return correction * blurred(noise, width);
  }

 private:
  static constexpr int nodes = 129;
  static constexpr float widest = 3;  ///< footprint; no noise is left

  float blurred(float noise, float width) const {
    constexpr float slope = 1.5f, largest = 0.31f;
    const float scale = std::min(std::hypot(thickness_, 0.5f * slope * width), largest);
    return thickness_ / scale * std::exp(-std::fabs(noise * noise_visibility(width)) / scale);
  }
  float blurred_mean(float width) const {
    double sum = 0;
    for (const float noise : noise_classes()) sum += double(blurred(noise, width));
    return float(sum / double(noise_classes().size()));
  }

  float thickness_, mean_;
  std::array<float, nodes> corrections_;
};

const Vein& large_vein() {
  static const Vein vein(0.035f);
  return vein;
}
const Vein& fine_vein() {
  static const Vein vein(0.03f);
  return vein;
}

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
        space_(arguments.transform("to_world")) {}

  Spectrum eval(const TextureCoordinates& at, const Wavelengths& wavelengths) const override {
    return mixed(
        ground_.at(wavelengths), vein_.at(wavelengths),
        contrast_ * darkness(space_.point(at) * frequency_, space_.width(at) * frequency_));
  }
  float maximum() const override {
    return std::max(ground_.rgb().max_lane(), vein_.rgb().max_lane());
  }
  Spectrum mean() const override {
    return mixed(ground_.rgb(), vein_.rgb(),
                 contrast_ * shade(0.5f, large_vein().mean(), fine_vein().mean(), 0.5f));
  }
  HeightGradient height_gradient(const TextureCoordinates&) const override { return {}; }

 private:
  /// The same point, pushed about by noise.
  Vec3f warped(const Vec3f& p, float width, float strength, uint32_t seed) const {
    return p + FractalNoise{4, 0.55f, seed}.vector(p, width) * strength;
  }
  float darkness(const Vec3f& p, float width) const {
    const float clouds =
        0.5f + 0.9f * FractalNoise{5, 0.55f, seed_ + 11}.value(p * 0.7f, 0.7f * width);
    const Vec3f bent = warped(p * 0.8f, 0.8f * width, 1.1f, seed_ + 23);
    // Veins come in groups: where a slow noise is low there are none.
    const float groups = std::clamp(
        0.5f + 1.8f * noise_visibility(0.45f * width) * gradient_noise_value(p * 0.45f, seed_ + 37),
        0.0f, 1.0f);
    const float large = large_vein()(gradient_noise_value(bent * 0.9f, seed_ + 41), width);
    const Vec3f fine_bent = warped(p * 2.3f, 2.3f * width, 0.9f, seed_ + 53);
    const float fine =
        fine_vein()(gradient_noise_value(fine_bent * 1.1f, seed_ + 61), 2.5f * width);
    const float crystals = FractalNoise{3, 0.7f, seed_ + 71}.value(p * 60.0f, 60 * width);
    return shade(std::clamp(clouds, 0.0f, 1.0f), large, fine, groups) + 0.05f * crystals;
  }
  /// Of clouds and veins, whose means are those of the parts: they are independent.
  static float shade(float clouds, float large, float fine, float groups) {
    return 0.16f * clouds + 0.75f * large * (0.25f + 0.75f * groups) + 0.35f * fine * groups;
  }

  SpectralValue ground_, vein_;
  float frequency_, contrast_;
  uint32_t seed_;
  SpaceTransform space_;
};

const TypeInfo& marble_info() {
  static const TypeInfo info{
      "texture",
      "marble",
      "Polished marble with veins. It is a pattern in space that goes through solids.",
      {texture_color("color0", {0.80, 0.78, 0.74}, "Colour of the stone."),
       texture_color("color1", {0.16, 0.17, 0.18}, "Colour of the veins."),
       number_parameter("scale", 0.4, "Distance between large veins.").range(1e-6, 1e6).in("m"),
       number_parameter("contrast", 1, "Strength of veins and clouds.").range(0, 1),
       seed_parameter(), texture_to_world_parameter()}};
  return info;
}

std::shared_ptr<const Texture> create_marble(const TextureInputs& in) {
  return std::make_shared<Marble>(in.arguments);
}

}  // namespace

TextureType marble_type() { return {marble_info(), create_marble}; }

}  // namespace kaustik
