// Operators that scale: "linear" and "srgb".

#include "kaustik/image/tone_operators.h"

namespace kaustik {
namespace {

class Linear : public ToneOperator {
 public:
  explicit Linear(float scale) : scale_(scale) {}
  std::vector<Vec3f> displayed(Picture picture) const override {
    std::vector<Vec3f> colours = with_parts(picture);
    for (Vec3f& colour : colours) colour *= scale_ * picture.exposure;
    return colours;
  }

 private:
  float scale_;
};

}  // namespace

Parameter exposure_parameter() {
  return number_parameter("exposure", 0, "Doublings of the light before it is shown.")
      .range(-100, 100)
      .in("stops");
}

ToneOperatorType srgb_tone() {
  return {{"tonemap",
           "srgb",
           "Radiance 1 W/(sr·m²) becomes white, with the film's exposure; nothing else is changed.",
           {}},
          [](const Arguments&) -> std::unique_ptr<ToneOperator> {
            return std::make_unique<Linear>(1.0f);
          }};
}

ToneOperatorType linear_tone() {
  return {{"tonemap",
           "linear",
           "Radiance is multiplied by 2^exposure, and the film's; then 1 becomes white.",
           {exposure_parameter()}},
          [](const Arguments& arguments) -> std::unique_ptr<ToneOperator> {
            return std::make_unique<Linear>(float(std::exp2(arguments.number("exposure"))));
          }};
}

}  // namespace kaustik
