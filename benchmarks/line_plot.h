#pragma once
#include <string>
#include <utility>
#include <vector>

namespace kaustik::bench {

struct Curve {
  std::string label;
  std::vector<std::pair<double, double>> points;
  std::string color;  ///< as CSS has it
  bool dashed = false;
};

/// Curves over linear axes, which start at zero, or logarithmic ones, which leave out what is not
/// above zero.
struct LinePlot {
  std::string title, x_label, y_label;
  bool logarithmic = false;  ///< both axes
  std::vector<Curve> curves;
  /// As SVG, readable on light and dark pages.
  std::string svg() const;
};

}  // namespace kaustik::bench
