// "histogram": the visibility matching operator of Ward Larson, Rushmeier and Piatko 1997.

#include "kaustik/base/error.h"
#include "kaustik/image/eye_model.h"
#include "kaustik/image/histogram_adjustment.h"
#include "kaustik/image/photometry.h"
#include "kaustik/image/tone_operators.h"
#include "kaustik/image/vision.h"

namespace kaustik {
namespace {

class Histogram : public ToneOperator {
 public:
  explicit Histogram(const Arguments& arguments)
      : exposure_(float(std::exp2(arguments.number("exposure")))) {
    const bool human = arguments.boolean("human");
    const auto model = [&](const char* name) {
      return arguments.given(name) ? arguments.boolean(name) : human;
    };
    has_glare_ = model("glare");
    loses_acuity_ = model("acuity");
    loses_color_ = model("color_sensitivity");
    settings_.human_contrast = model("contrast_sensitivity");
    settings_.smooth = arguments.boolean("smooth");
    settings_.bins = int(arguments.integer("bins"));
    settings_.display_white = arguments.number("display_maximum");
    settings_.display_black = settings_.display_white / arguments.number("display_range");
    if (!arguments.has("display_minimum")) return;
    settings_.display_black = arguments.number("display_minimum");
    if (settings_.display_black > settings_.display_white / 1.01)
      throw Error(ErrorKind::input, "display_minimum is not below display_maximum",
                  "give the luminance of the display's black, such as 0.5 cd/m²",
                  arguments.place_of("display_minimum"));
  }

  bool needs_view() const override { return true; }
  /// Glare and acuity are known of whole pixels only.
  bool shows_parts() const override { return !has_glare_ && !loses_acuity_; }
  /// The order of the paper's section 6.
  std::vector<Vec3f> displayed(Picture picture) const override {
    for (Vec3f& colour : picture.pixels) colour *= exposure_;
    for (Vec3f& colour : picture.parts) colour *= exposure_;
    Grid<Vec3f> foveal = foveal_means(picture);
    if (has_glare_) {
      const Grid<Vec3f> scattered = veil(foveal, picture);
      add_veil(picture, scattered);
      foveal = foveal_means(picture);
    }
    if (loses_acuity_) blur_to_acuity(picture, foveal);
    if (loses_color_) {
      for (Vec3f& colour : picture.pixels) colour = seen_color(colour);
      for (Vec3f& colour : picture.parts) colour = seen_color(colour);
      for (Vec3f& colour : foveal.cells) colour = seen_color(colour);
    }
    std::vector<float> luminances;
    for (const Vec3f& colour : foveal.cells) luminances.push_back(luminance(colour));
    std::vector<Vec3f> colours = with_parts(std::move(picture));
    apply(HistogramAdjustment(luminances, settings_), colours);
    return colours;
  }

 private:
  /// The display adds its black to what it is sent.
  void apply(const HistogramAdjustment& curve, std::vector<Vec3f>& pixels) const {
    const double black = settings_.display_black, range = settings_.display_white - black;
    for (Vec3f& colour : pixels) {
      const float y = photopic(colour);
      if (!(y > 0)) {
        colour = Vec3f(0);
        continue;
      }
      const double shown = (double(curve.display_luminance(white_efficacy * y)) - black) / range;
      // Hue first: for the darkest colours the factor alone would overflow.
      colour = colour / y * float(shown);
    }
  }

  HistogramSettings settings_;
  float exposure_;
  bool has_glare_, loses_acuity_, loses_color_;
};

std::vector<Parameter> histogram_parameters() {
  return {
      number_parameter("display_maximum", 100, "Luminance of the display's white.")
          .range(1e-3, 1e6)
          .in("cd/m²"),
      number_parameter("display_range", 100, "Ratio of the display's white to its black.")
          .range(1.01, 1e9),
      optional(number_parameter("display_minimum", 1,
                                "Luminance of the display's black, instead of display_range."))
          .range(1e-9, 1e6)
          .in("cd/m²"),
      number_parameter("exposure", 0,
                       "Exposure added to the scene. It only affects the models of the eye.")
          .range(-100, 100)
          .in("stops"),
      boolean_parameter("human", false, "Default of the next four parameters."),
      boolean_parameter("contrast_sensitivity", false,
                        "Limit contrast to what an eye sees at this luminance. If false, limit it "
                        "to the contrast of the scene."),
      boolean_parameter("glare", false, "Add the veil of light that the eye scatters."),
      boolean_parameter("acuity", false, "Blur dark regions that an eye does not see sharply."),
      boolean_parameter("color_sensitivity", false, "Let colours fade in the dark."),
      boolean_parameter("smooth", true,
                        "Avoid bands at luminances that few pixels have. False: the paper's "
                        "algorithm to the letter."),
      integer_parameter("bins", 100, "Bins of the histogram of log luminance.").range(2, 100000)};
}

}  // namespace

ToneOperatorType histogram_tone() {
  return {{"tonemap", "histogram",
           "Histogram adjustment with models of human vision (Ward Larson, Rushmeier and Piatko "
           "1997): details that are visible in the scene stay visible on the display.",
           histogram_parameters()},
          [](const Arguments& arguments) -> std::unique_ptr<ToneOperator> {
            return std::make_unique<Histogram>(arguments);
          }};
}

}  // namespace kaustik
