#include "line_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kaustik::bench {
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
  double minimum = 0, maximum = 1;
  bool logarithmic = false;
  std::vector<double> marks;  ///< the first is the minimum, the last the maximum

  /// 0 at the minimum, 1 at the maximum.
  double place(double value) const {
    return logarithmic ? std::log(value / minimum) / std::log(maximum / minimum)
                       : (value - minimum) / (maximum - minimum);
  }
};

Axis linear_axis(double largest) {
  const double distance = mark_distance(largest);
  Axis axis;
  axis.maximum = std::ceil(largest / distance - 1e-9) * distance;
  for (double x = 0; x <= axis.maximum * 1.0001; x += distance) axis.marks.push_back(x);
  return axis;
}

/// Marks at 1, 2 and 5 times powers of ten, or only at those where there are many; the outermost
/// enclose all values.
Axis logarithmic_axis(double smallest, double largest) {
  const int first = int(std::floor(std::log10(smallest) + 1e-9));
  const int last = int(std::ceil(std::log10(largest) - 1e-9));
  std::vector<double> marks;
  for (int power = first; power <= std::max(last, first + 1); ++power)
    for (const double factor : {1.0, 2.0, 5.0})
      if (factor == 1 || last - first <= 2) marks.push_back(factor * std::pow(10, power));
  while (marks.size() > 2 && marks[1] <= smallest * 1.0001) marks.erase(marks.begin());
  while (marks.size() > 2 && marks[marks.size() - 2] >= largest * 0.9999) marks.pop_back();
  return {marks.front(), marks.back(), true, marks};
}

Axis axis_of(const std::vector<double>& values, bool logarithmic) {
  double smallest = std::numeric_limits<double>::infinity(), largest = 1e-30;
  for (const double value : values) {
    largest = std::max(largest, value);
    if (value > 0) smallest = std::min(smallest, value);
  }
  return logarithmic ? logarithmic_axis(std::min(smallest, largest), largest)
                     : linear_axis(largest);
}

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
  std::vector<double> xs, ys;
  for (const Curve& curve : curves)
    for (const auto& [x, y] : curve.points) {
      xs.push_back(x);
      ys.push_back(y);
    }
  const Axis x_axis = axis_of(xs, logarithmic), y_axis = axis_of(ys, logarithmic);
  const auto place_x = [&](double x) { return left + x_axis.place(x) * (width - left - right); };
  const auto place_y = [&](double y) {
    return height - bottom - y_axis.place(y) * (height - top - bottom);
  };

  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
      "font-family=\"sans-serif\" font-size=\"13\">\n"
      "<rect width=\"{0:.0f}\" height=\"{1:.0f}\" fill=\"white\"/>\n",
      width, height);
  out += text_at(left, 24, "start", title, " font-weight=\"bold\"");
  for (const double x : x_axis.marks) {
    out +=
        line(place_x(x), place_y(y_axis.minimum), place_x(x), place_y(y_axis.maximum), "#e4e4e4");
    out += text_at(place_x(x), height - bottom + 18, "middle", fmt::format("{:.4g}", x));
  }
  for (const double y : y_axis.marks) {
    out +=
        line(place_x(x_axis.minimum), place_y(y), place_x(x_axis.maximum), place_y(y), "#e4e4e4");
    out += text_at(left - 8, place_y(y) + 4, "end", fmt::format("{:.4g}", y));
  }
  out += text_at((left + width - right) / 2, height - 14, "middle", x_label);
  out += text_at(
      0, 0, "middle", y_label,
      fmt::format(" transform=\"translate(18 {:.0f}) rotate(-90)\"", (top + height - bottom) / 2));
  double legend_y = top + 8;
  for (Curve curve : curves) {
    if (logarithmic)
      std::erase_if(curve.points, [](const auto& p) { return p.first <= 0 || p.second <= 0; });
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

}  // namespace kaustik::bench
