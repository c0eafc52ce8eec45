// Planes of intensities, as files have them, to a table of all directions.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "kaustik/light/photometric_file.h"

namespace kaustik {
namespace {

constexpr double degree = std::numbers::pi / 180;

/// In which order values ascend, equal ones left out.
std::vector<size_t> ascending_order(const std::vector<double>& values) {
  std::vector<size_t> order(values.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return values[a] < values[b]; });
  order.erase(std::unique(order.begin(), order.end(),
                          [&](size_t a, size_t b) { return values[b] - values[a] < 1e-6; }),
              order.end());
  return order;
}

bool is_identity(const std::vector<size_t>& order, size_t count) {
  if (order.size() != count) return false;
  for (size_t i = 0; i < order.size(); ++i)
    if (order[i] != i) return false;
  return true;
}

double within_turn(double degrees) {
  const double rest = std::fmod(degrees, 360);
  return rest < 0 ? rest + 360 : rest;
}

/// Columns all around: which plane each shows, by its angle in [0, 360).
std::map<double, size_t> columns_of(const PhotometricPlanes& planes) {
  std::map<double, size_t> columns;
  const auto add = [&](double degrees, size_t plane) {
    // In steps of a millionth, so that 360 is 0 and mirrored planes meet.
    columns.try_emplace(within_turn(std::round(degrees * 1e6) / 1e6), plane);
  };
  for (size_t i = 0; i < planes.planes.size(); ++i) add(planes.planes[i], i);
  for (size_t i = 0; i < planes.planes.size(); ++i) {
    const double c = planes.planes[i];
    if (planes.mirror_at_0) add(-c, i);
    if (planes.mirror_at_90) add(180 - c, i);
    if (planes.mirror_at_0 && planes.mirror_at_90) add(180 + c, i);
  }
  return columns;
}

/// Where the first angle is within one step of the axis, what is measured there goes on to it.
void reach_axis(std::vector<double>& angles, std::vector<float>& values, size_t columns,
                std::vector<std::string>& remarks) {
  const auto copy_row = [&](size_t row, bool in_front) {
    const std::vector<float> copy(values.begin() + std::ptrdiff_t(row * columns),
                                  values.begin() + std::ptrdiff_t((row + 1) * columns));
    values.insert(in_front ? values.begin() : values.end(), copy.begin(), copy.end());
  };
  const double step = angles[1] - angles[0];
  if (angles.front() > 0 && angles.front() < 45 && angles.front() <= 1.001 * step) {
    remarks.push_back(
        fmt::format("the first angle is {:.4g}°: from there to 0° the intensity "
                    "stays as it is",
                    angles.front()));
    copy_row(0, true);
    angles.insert(angles.begin(), 0);
  }
  const double last_step = angles.back() - angles[angles.size() - 2];
  if (angles.back() < 180 && angles.back() > 135 && 180 - angles.back() <= 1.001 * last_step) {
    remarks.push_back(
        fmt::format("the last angle is {:.4g}°: from there to 180° the intensity "
                    "stays as it is",
                    angles.back()));
    copy_row(angles.size() - 1, false);
    angles.push_back(180);
  }
}

/// Between the nodes of a sheaf, in degrees; zero outside of it.
class Sheaf {
 public:
  explicit Sheaf(const PhotometricPlanes& planes) : planes_(planes) {}

  double at(double h, double v) const {
    size_t plane, angle;
    double s, t;
    if (!find(planes_.planes, h, plane, s) || !find(planes_.angles, v, angle, t)) return 0;
    const auto across = [&](size_t p) {
      return std::lerp(planes_.at(p, angle), planes_.at(p, angle + 1), t);
    };
    return std::lerp(across(plane), across(plane + 1), s);
  }

 private:
  /// The node before it, and how far it is to the next one.
  static bool find(const std::vector<double>& nodes, double x, size_t& before, double& share) {
    if (nodes.front() >= 0) x = std::fabs(x);
    constexpr double slack = 1e-6;
    if (x < nodes.front() - slack || x > nodes.back() + slack) return false;
    const auto after = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, x);
    before = size_t(after - nodes.begin()) - 1;
    share = std::clamp((x - nodes[before]) / (*after - nodes[before]), 0.0, 1.0);
    return true;
  }

  const PhotometricPlanes& planes_;
};

}  // namespace

void tidy(PhotometricPlanes& planes, std::vector<std::string>& remarks) {
  const std::vector<size_t> rows = ascending_order(planes.angles);
  const std::vector<size_t> columns = ascending_order(planes.planes);
  if (!is_identity(rows, planes.angles.size()) || !is_identity(columns, planes.planes.size()))
    remarks.emplace_back(
        "its angles do not ascend, or are there twice: they are sorted, and the "
        "first of equal ones counts");
  PhotometricPlanes sorted = planes;
  sorted.planes.clear();
  sorted.angles.clear();
  sorted.candelas.clear();
  for (const size_t row : rows) sorted.angles.push_back(planes.angles[row]);
  size_t negative = 0;
  for (const size_t column : columns) {
    sorted.planes.push_back(planes.planes[column]);
    for (const size_t row : rows) {
      const double candela = planes.at(column, row);
      if (candela < 0) ++negative;
      sorted.candelas.push_back(std::max(candela, 0.0));
    }
  }
  if (negative > 0)
    remarks.push_back(fmt::format("{} of its intensities {} below 0: they are taken as 0", negative,
                                  negative == 1 ? "is" : "are"));
  planes = std::move(sorted);
}

IntensityTable table_of_planes(const PhotometricPlanes& planes, std::vector<std::string>& remarks) {
  const std::map<double, size_t> columns = columns_of(planes);
  std::vector<double> turns, angles = planes.angles;
  for (const auto& [degrees, plane] : columns) turns.push_back(degrees / 360);
  std::vector<float> values;
  values.reserve(columns.size() * angles.size());
  for (size_t row = 0; row < angles.size(); ++row)
    for (const auto& [degrees, plane] : columns) values.push_back(float(planes.at(plane, row)));
  reach_axis(angles, values, turns.size(), remarks);
  for (double& angle : angles) angle = std::min(angle * degree, std::numbers::pi);
  return {std::move(turns), std::move(angles), std::move(values)};
}

IntensityTable table_of_sheaves(const PhotometricPlanes& planes, bool is_type_a) {
  constexpr int columns = 360, rows = 181;
  const Sheaf sheaf(planes);
  std::vector<double> turns, angles;
  std::vector<float> values;
  for (int column = 0; column < columns; ++column) turns.push_back(double(column) / columns);
  for (int row = 0; row < rows; ++row) {
    const double gamma = row * degree;
    angles.push_back(std::min(gamma, std::numbers::pi));
    for (int column = 0; column < columns; ++column) {
      const double c = column * degree;
      const double z = std::cos(gamma), x = std::sin(gamma) * std::cos(c),
                   y = std::sin(gamma) * std::sin(c);
      // Beyond the horizon is what lies behind: no angle of a sheaf leads there.
      const double round = std::atan2(x, z) / degree;
      const double up = std::asin(std::clamp(y, -1.0, 1.0)) / degree;
      values.push_back(float(is_type_a ? sheaf.at(round, up) : sheaf.at(up, round)));
    }
  }
  // Where all light is before some angle, it ends there, not a step later.
  const auto is_dark = [](float value) { return !(value > 0); };
  while (angles.size() > 2 && std::all_of(values.end() - columns, values.end(), is_dark)) {
    values.resize(values.size() - columns);
    angles.pop_back();
  }
  return {std::move(turns), std::move(angles), std::move(values)};
}

}  // namespace kaustik
