// "aces": the film-like look of the Academy Color Encoding System.

#include "kaustik/image/tone_operators.h"

namespace kaustik {
namespace {

/// Reference rendering transform and sRGB output transform at once, as fitted by Hill 2016: into
/// the rendering primaries, a rational curve per channel, and back.
Vec3f filmic(const Vec3f& rgb) {
  const Vec3f c(0.59719f * rgb.x + 0.35458f * rgb.y + 0.04823f * rgb.z,
                0.07600f * rgb.x + 0.90834f * rgb.y + 0.01566f * rgb.z,
                0.02840f * rgb.x + 0.13383f * rgb.y + 0.83777f * rgb.z);
  Vec3f f;
  for (int i = 0; i < 3; ++i) {
    // In double precision, and no infinity over infinity for what is far beyond white.
    const double x = std::clamp(double(c[i]), 0.0, 1e6);
    f[i] = float((x * (x + 0.0245786) - 0.000090537) / (x * (0.983729 * x + 0.4329510) + 0.238081));
  }
  return {1.60475f * f.x - 0.53108f * f.y - 0.07367f * f.z,
          -0.10208f * f.x + 1.10813f * f.y - 0.00605f * f.z,
          -0.00327f * f.x - 0.07276f * f.y + 1.07602f * f.z};
}

class Aces : public ToneOperator {
 public:
  explicit Aces(float scale) : scale_(scale) {}
  std::vector<Vec3f> displayed(Picture picture) const override {
    std::vector<Vec3f> colours = with_parts(picture);
    for (Vec3f& colour : colours) colour = filmic(colour * (scale_ * picture.exposure));
    return colours;
  }

 private:
  float scale_;
};

}  // namespace

ToneOperatorType aces_tone() {
  return {{"tonemap",
           "aces",
           "The film-like curve of the Academy Color Encoding System (Hill's fit of its reference "
           "rendering and sRGB output transforms).",
           {exposure_parameter()}},
          [](const Arguments& arguments) -> std::unique_ptr<ToneOperator> {
            return std::make_unique<Aces>(float(std::exp2(arguments.number("exposure"))));
          }};
}

}  // namespace kaustik
