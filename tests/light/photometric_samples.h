#pragma once
// Files of luminaires, made up.

#include <fmt/format.h>

#include <numbers>
#include <string>
#include <vector>

namespace kaustik::testing {

inline constexpr double double_pi = std::numbers::pi;

/// An IES file of one lamp of 1000 lm; `candelas(c, v)`: by plane, then vertical angle.
template <typename Candelas>
std::string ies_text(const std::vector<double>& vertical, const std::vector<double>& horizontal,
                     const Candelas& candelas, const std::string& version = "IESNA:LM-63-2002",
                     int type = 1, const std::string& factors = "1 1 1") {
  std::string text = version + "\n[TEST] made up\nTILT=NONE\n";
  text += fmt::format("1 1000 1 {} {} {} 2 0 0 0\n{}\n", vertical.size(), horizontal.size(), type,
                      factors);
  for (const auto* angles : {&vertical, &horizontal}) {
    for (const double angle : *angles) text += fmt::format("{} ", angle);
    text += "\n";
  }
  for (const double h : horizontal) {
    for (const double v : vertical) text += fmt::format("{:.9g} ", double(candelas(h, v)));
    text += "\n";
  }
  return text;
}

/// So many even steps.
inline std::vector<double> even_angles(double from, double to, int steps) {
  std::vector<double> angles;
  for (int i = 0; i <= steps; ++i) angles.push_back(from + (to - from) * i / steps);
  return angles;
}

/// A EULUMDAT file of 2000 lm, whose planes are those of all C angles; `stored`: those whose values
/// follow, in cd per 1000 lm.
template <typename Candelas>
std::string eulumdat_text(int symmetry, const std::vector<double>& planes,
                          const std::vector<double>& stored, const std::vector<double>& angles,
                          const Candelas& candelas, double efficiency = 0) {
  std::string text = "Maker\n1\n" + std::to_string(symmetry) + "\n";
  text += fmt::format("{}\n30\n{}\n5\nreport\nname\nnumber\nfile\ndate\n", planes.size(),
                      angles.size());
  text += "100\n0\n50\n90\n0\n0\n0\n0\n0\n100\n" + fmt::format("{}\n1,0\n0\n", efficiency);
  text += "1\n2\nLED\n2000\n3000K\n80\n20\n";
  for (int i = 0; i < 10; ++i) text += "0.5\n";
  for (const auto* list : {&planes, &angles})
    for (const double angle : *list) text += fmt::format("{}\n", angle);
  for (const double c : stored)
    for (const double g : angles) text += fmt::format("{:.6f}\n", double(candelas(c, g)));
  return text;
}

}  // namespace kaustik::testing
