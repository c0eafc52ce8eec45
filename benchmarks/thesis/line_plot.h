#pragma once
#include <string>
#include <utility>
#include <vector>

namespace kaustik::thesis {

struct Curve {
  std::string label;
  std::vector<std::pair<double, double>> points;
  std::string color;  ///< as CSS has it
  bool dashed = false;
};

/// Curves over linear axes that start at zero.
struct LinePlot {
  std::string title, x_label, y_label;
  std::vector<Curve> curves;
  /// As SVG, readable on light and dark pages.
  std::string svg() const;
};

}  // namespace kaustik::thesis
