// "falsecolor": how bright it is, in colours, with a scale in cd/m² or lx.

#include <fmt/format.h>

#include "kaustik/base/to_integer.h"
#include "kaustik/image/color_scale.h"
#include "kaustik/image/photometry.h"
#include "kaustik/image/stroke_font.h"
#include "kaustik/image/tone_operators.h"

namespace kaustik {
namespace {

std::vector<double> luminances(const Picture& picture) {
  std::vector<double> values;
  values.reserve(picture.pixels.size());
  for (const Vec3f& colour : picture.pixels) values.push_back(double(luminance(colour)));
  return values;
}

void fill(Image& image, int x0, int y0, int x1, int y1, const Vec3f& color) {
  for (int c = 0; c < 3; ++c)
    for (int y = std::max(0, y0); y < std::min(y1, image.height()); ++y)
      for (int x = std::max(0, x0); x < std::min(x1, image.width()); ++x)
        image.at(x, y, c) = color[c];
}

enum class Contours { none, lines, bands };

class FalseColor : public ToneOperator {
 public:
  explicit FalseColor(const Arguments& arguments)
      : quantity_(arguments.text("quantity")), has_legend_(arguments.boolean("legend")) {
    scale_.is_logarithmic = arguments.text("scale") == "log";
    if (arguments.has("minimum")) scale_.minimum = arguments.number("minimum");
    if (arguments.has("maximum")) scale_.maximum = arguments.number("maximum");
    const std::string& contours = arguments.text("contours");
    contours_ = contours == "lines"   ? Contours::lines
                : contours == "bands" ? Contours::bands
                                      : Contours::none;
  }

  std::vector<Vec3f> displayed(Picture picture) const override {
    const std::vector<double> values = luminances(picture);
    const ColorScale scale = make_scale(values, scale_);
    for (size_t i = 0; i < values.size(); ++i) picture.pixels[i] = color_of(values[i], scale);
    if (contours_ == Contours::lines) draw_lines(picture, values, scale);
    return std::move(picture.pixels);
  }

  bool shows_parts() const override { return false; }

  Image decorated(Image shown, const Picture& picture) const override {
    return has_legend_ ? with_legend(shown, picture) : shown;
  }

 private:
  Vec3f color_of(double value, const ColorScale& scale) const {
    if (contours_ != Contours::bands) return viridis(float(scale.position(value)));
    // The whole palette over the bands: the first has its first colour, the last its last.
    const size_t bands = scale.ticks.size() - 1;
    return bands < 2 ? viridis(0.5f) : viridis(float(scale.band(value)) / float(bands - 1));
  }

  /// Where the next pixel to the right or below is in another band.
  static void draw_lines(Picture& picture, const std::vector<double>& values,
                         const ColorScale& scale) {
    Grid<size_t> bands{picture.width, picture.height, {}};
    for (const double value : values) bands.cells.push_back(scale.band(value));
    size_t i = 0;
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x, ++i) {
        const size_t right = bands.at(std::min(x + 1, picture.width - 1), y);
        const size_t below = bands.at(x, std::min(y + 1, picture.height - 1));
        if (bands.at(x, y) == right && bands.at(x, y) == below) continue;
        picture.pixels[i] = Vec3f(scale.position(values[i]) < 0.5 ? 1.0f : 0.0f);
      }
  }

  std::vector<std::string> labels(const ColorScale& scale,
                                  const std::vector<double>& values) const {
    std::vector<std::string> result;
    for (const double tick : scale.ticks) result.push_back(fmt::format("{:.6g}", tick));
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    // The outermost colours also stand for what lies beyond them.
    if (*high > scale.maximum * (1 + 1e-6)) result.back() = "≥" + result.back();
    if (*low < scale.minimum * (1 - 1e-6)) result.front() = "≤" + result.front();
    return result;
  }

  Image with_legend(const Image& shown, const Picture& picture) const {
    const std::vector<double> values = luminances(picture);
    const ColorScale scale = make_scale(values, scale_);
    const std::vector<std::string> texts = labels(scale, values);
    const bool in_lux = quantity_ == "auto" ? picture.is_irradiance : quantity_ == "illuminance";
    const std::string unit = in_lux ? "lx" : "cd/m²";
    const Vec3f paper(0.015f), ink(0.85f);
    // All measures hang on the height of a digit.
    const float digit = std::clamp(float(shown.height()) / 34, 9.0f, 60.0f);
    float widest = text_width(unit);
    for (const std::string& text : texts) widest = std::max(widest, text_width(text));
    const int margin = int(digit), bar = int(1.5f * digit), tick = int(digit / 2);
    const int height = std::max(shown.height(), int(digit * (4 + 1.8f * float(texts.size()))));
    const int left = shown.width() + margin, right = left + bar;
    const int width = right + tick + int(digit / 2 + widest * digit) + margin;
    Image result(width, height, {"R", "G", "B"});
    fill(result, 0, 0, width, height, paper);
    for (int c = 0; c < 3; ++c)
      for (int y = 0; y < shown.height(); ++y)
        for (int x = 0; x < shown.width(); ++x) result.at(x, y, c) = shown.at(x, y, c);

    draw_text(result, unit, float(left), 2 * digit, digit, ink);
    const int top = int(3.5f * digit), bottom = height - margin - int(digit / 2);
    for (int y = top; y < bottom; ++y) {
      const double t = (double(bottom - y) - 0.5) / double(bottom - top);
      fill(result, left, y, right, y + 1, color_of(value_at(t, scale), scale));
    }
    for (size_t i = 0; i < texts.size(); ++i) {
      const float y = float(bottom) - float(scale.position(scale.ticks[i])) * float(bottom - top);
      const int line = to_integer(y, top, bottom - 1);
      fill(result, right, line, right + tick, line + 1, ink);
      draw_text(result, texts[i], float(right + tick) + digit / 2, y + digit / 2, digit, ink);
    }
    return result;
  }

  static double value_at(double t, const ColorScale& scale) {
    return scale.is_logarithmic ? scale.minimum * std::pow(scale.maximum / scale.minimum, t)
                                : scale.minimum + t * (scale.maximum - scale.minimum);
  }

  std::string quantity_;
  ScaleSettings scale_;
  Contours contours_ = Contours::none;
  bool has_legend_;
};

std::vector<Parameter> parameters() {
  return {choice_parameter("quantity", "auto", {"auto", "luminance", "illuminance"},
                           "Content of the layer: radiance, shown in cd/m², or irradiance, in lx; "
                           "auto: the picture's metadata 'quantity', or radiance without it. Both "
                           "are 179 lm/W times the photopic part."),
          choice_parameter("scale", "linear", {"linear", "log"},
                           "Scale on which values become colours."),
          optional(number_parameter("minimum", 0, "Start of the scale; a round number if absent."))
              .in("cd/m² or lx"),
          optional(number_parameter(
                       "maximum", 1,
                       "End of the scale; if absent, a round number above 98 % of the pixels."))
              .in("cd/m² or lx"),
          choice_parameter("contours", "none", {"none", "lines", "bands"},
                           "Lines at the numbers of the scale, or one colour between two numbers."),
          boolean_parameter("legend", true, "Draw the scale to the right of the picture.")};
}

}  // namespace

ToneOperatorType falsecolor_tone() {
  return {
      {"tonemap", "falsecolor",
       "Luminance or illuminance in colours (viridis), with a scale in cd/m² or lx.", parameters()},
      [](const Arguments& arguments) -> std::unique_ptr<ToneOperator> {
        return std::make_unique<FalseColor>(arguments);
      }};
}

}  // namespace kaustik
