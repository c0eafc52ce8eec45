#include "kaustik/material/direction_grid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kaustik {
namespace {

constexpr double nodes[] = {0.0198550717512319, 0.1016667612931866, 0.2372337950418355,
                            0.4082826787521751, 0.5917173212478249, 0.7627662049581645,
                            0.8983332387068134, 0.9801449282487682};
constexpr double weights[] = {0.0506142681451881, 0.1111905172266872, 0.1568533229389436,
                              0.1813418916891810, 0.1813418916891810, 0.1568533229389436,
                              0.1111905172266872, 0.0506142681451881};

struct Range {
  double theta0, theta1, phi0, phi1;
};

/// Gauss and Legendre's rule of 8 × 8 points.
Vec3d gauss(const std::function<Vec3d(const Vec3f&)>& f, const Range& r) {
  Vec3d sum(0, 0, 0);
  for (int i = 0; i < 8; ++i) {
    const double theta = std::lerp(r.theta0, r.theta1, nodes[i]);
    const double sin_theta = std::sin(theta), cos_theta = std::cos(theta);
    for (int j = 0; j < 8; ++j) {
      const double phi = std::lerp(r.phi0, r.phi1, nodes[j]);
      const Vec3f w(float(sin_theta * std::cos(phi)), float(sin_theta * std::sin(phi)),
                    float(cos_theta));
      sum += f(w) * (weights[i] * weights[j] * sin_theta);
    }
  }
  return sum * (r.theta1 - r.theta0) * (r.phi1 - r.phi0);
}

Vec3d adaptive(const std::function<Vec3d(const Vec3f&)>& f, const Range& r, const Vec3d& whole,
               int depth) {
  const double theta = 0.5 * (r.theta0 + r.theta1), phi = 0.5 * (r.phi0 + r.phi1);
  const Range quarters[] = {{r.theta0, theta, r.phi0, phi},
                            {theta, r.theta1, r.phi0, phi},
                            {r.theta0, theta, phi, r.phi1},
                            {theta, r.theta1, phi, r.phi1}};
  Vec3d parts[4], sum(0, 0, 0);
  for (int i = 0; i < 4; ++i) sum += parts[i] = gauss(f, quarters[i]);
  const Vec3d change = sum - whole;
  const double error = std::fabs(change.x) + std::fabs(change.y) + std::fabs(change.z);
  if (depth > 0 && (depth >= 9 || error < 2e-6)) return sum;
  sum = Vec3d(0, 0, 0);
  for (int i = 0; i < 4; ++i) sum += adaptive(f, quarters[i], parts[i], depth + 1);
  return sum;
}

}  // namespace

DirectionGrid::DirectionGrid(const Vec3f& wo)
    : thetas_{0, 0.5 * std::numbers::pi, std::numbers::pi},
      phis_{-std::numbers::pi, -0.5, -0.1, 0, 0.1, 0.5, std::numbers::pi},
      first_phi_(std::atan2(-wo.y, -wo.x)) {
  const double mirror_theta = std::acos(wo.z);
  for (const double offset : {-0.25, -0.07, 0.0, 0.07, 0.25}) {
    const double theta = mirror_theta + offset;
    const auto near = [&](double border) { return std::fabs(theta - border) < 0.01; };
    if (theta > 0 && theta < std::numbers::pi && std::none_of(thetas_.begin(), thetas_.end(), near))
      thetas_.push_back(theta);
  }
  std::sort(thetas_.begin(), thetas_.end());
}

DirectionGrid DirectionGrid::even(int rows) {
  DirectionGrid grid;
  grid.thetas_ = {0.5 * std::numbers::pi};
  for (int i = 0; i <= rows; ++i)
    if (2 * i != rows) grid.thetas_.push_back(std::acos(1 - 2.0 * i / rows));
  std::sort(grid.thetas_.begin(), grid.thetas_.end());
  for (int i = -rows; i <= rows; ++i) grid.phis_.push_back(std::numbers::pi * i / rows);
  return grid;
}

size_t DirectionGrid::cell_of(const Vec3f& w) const {
  const double turns = (std::atan2(w.y, w.x) - first_phi_) / (2 * std::numbers::pi);
  const double phi = (turns - std::round(turns)) * 2 * std::numbers::pi;
  const double theta = std::acos(std::clamp(double(w.z), -1.0, 1.0));
  const auto interval = [](const std::vector<double>& borders, double x) {
    const auto next = std::upper_bound(borders.begin(), borders.end(), x);
    return size_t(std::clamp<std::ptrdiff_t>(next - borders.begin() - 1, 0,
                                             std::ptrdiff_t(borders.size()) - 2));
  };
  return interval(thetas_, theta) * (phis_.size() - 1) + interval(phis_, phi);
}

Vec3d DirectionGrid::integrate(size_t cell, const std::function<Vec3d(const Vec3f&)>& f) const {
  const size_t row = cell / (phis_.size() - 1), column = cell % (phis_.size() - 1);
  const Range range{thetas_[row], thetas_[row + 1], first_phi_ + phis_[column],
                    first_phi_ + phis_[column + 1]};
  return adaptive(f, range, Vec3d(0, 0, 0), 0);
}

}  // namespace kaustik
