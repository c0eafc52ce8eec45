#include "line_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kaustik::thesis {
namespace {

constexpr double width = 760, height = 460, left = 78, right = 190, top = 44, bottom = 58;

/// Distance between marks: 1, 2 or 5 times a power of ten, so that there are four to ten.
double mark_distance(double maximum) {
  const double power = std::pow(10, std::floor(std::log10(maximum)));
  for (const double factor : {0.1, 0.2, 0.5, 1.0})
    if (maximum / (factor * power) <= 8) return factor * power;
  return 2 * power;
}

struct Axis {
  double maximum, distance;
  explicit Axis(double largest) : distance(mark_distance(largest)) {
    maximum = std::ceil(largest / distance - 1e-9) * distance;
  }
};

std::string text_at(double x, double y, const std::string& anchor, const std::string& text,
                    const std::string& more = {}) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y,
                     anchor, more, text);
}

std::string line(double x0, double y0, double x1, double y1, const char* color) {
  return fmt::format(
      "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"/>\n", x0, y0, x1,
      y1, color);
}

}  // namespace

std::string LinePlot::svg() const {
  double largest_x = 1e-30, largest_y = 1e-30;
  for (const Curve& curve : curves)
    for (const auto& [x, y] : curve.points) {
      largest_x = std::max(largest_x, x);
      largest_y = std::max(largest_y, y);
    }
  const Axis x_axis(largest_x), y_axis(largest_y);
  const auto place_x = [&](double x) { return left + x / x_axis.maximum * (width - left - right); };
  const auto place_y = [&](double y) {
    return height - bottom - y / y_axis.maximum * (height - top - bottom);
  };

  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
      "font-family=\"sans-serif\" font-size=\"13\">\n"
      "<rect width=\"{0:.0f}\" height=\"{1:.0f}\" fill=\"white\"/>\n",
      width, height);
  out += text_at(left, 24, "start", title, " font-weight=\"bold\"");
  for (double x = 0; x <= x_axis.maximum * 1.0001; x += x_axis.distance) {
    out += line(place_x(x), place_y(0), place_x(x), place_y(y_axis.maximum), "#e4e4e4");
    out += text_at(place_x(x), height - bottom + 18, "middle", fmt::format("{:.4g}", x));
  }
  for (double y = 0; y <= y_axis.maximum * 1.0001; y += y_axis.distance) {
    out += line(place_x(0), place_y(y), place_x(x_axis.maximum), place_y(y), "#e4e4e4");
    out += text_at(left - 8, place_y(y) + 4, "end", fmt::format("{:.4g}", y));
  }
  out += text_at((left + width - right) / 2, height - 14, "middle", x_label);
  out += text_at(
      0, 0, "middle", y_label,
      fmt::format(" transform=\"translate(18 {:.0f}) rotate(-90)\"", (top + height - bottom) / 2));
  double legend_y = top + 8;
  for (const Curve& curve : curves) {
    std::string points;
    for (const auto& [x, y] : curve.points)
      points += fmt::format("{:.1f},{:.1f} ", place_x(x), place_y(y));
    const char* dash = curve.dashed ? " stroke-dasharray=\"6 4\"" : "";
    out +=
        fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"{}/>\n",
                    points, curve.color, dash);
    for (const auto& [x, y] : curve.points)
      out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.6\" fill=\"{}\"/>\n",
                         place_x(x), place_y(y), curve.color);
    const double x = width - right + 14;
    out += fmt::format(
        "<line x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{2:.1f}\" y2=\"{1:.1f}\" stroke=\"{3}\" "
        "stroke-width=\"2\"{4}/>\n",
        x, legend_y - 4, x + 24, curve.color, dash);
    out += text_at(x + 30, legend_y, "start", curve.label);
    legend_y += 20;
  }
  return out + "</svg>\n";
}

}  // namespace kaustik::thesis
