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
  return number_parameter("exposure", 0, "Exposure added before the picture is shown.")
      .range(-100, 100)
      .in("stops");
}

ToneOperatorType srgb_tone() {
  return {
      {"tonemap",
       "srgb",
       "Maps a radiance of 1 W/(sr·m²) to white, with the film's exposure. Nothing else changes.",
       {}},
      [](const Arguments&) -> std::unique_ptr<ToneOperator> {
        return std::make_unique<Linear>(1.0f);
      }};
}

ToneOperatorType linear_tone() {
  return {{"tonemap",
           "linear",
           "Multiplies radiance by 2^exposure and by the film's exposure. Then 1 becomes white.",
           {exposure_parameter()}},
          [](const Arguments& arguments) -> std::unique_ptr<ToneOperator> {
            return std::make_unique<Linear>(float(std::exp2(arguments.number("exposure"))));
          }};
}

}  // namespace kaustik
