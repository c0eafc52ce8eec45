#include "kaustik/light/intensity_table.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

namespace kaustik {
namespace {

/// The last of the nodes that is not above `x`; −1: there is none.
int node_before(const std::vector<double>& nodes, double x) {
  return int(std::upper_bound(nodes.begin(), nodes.end(), x) - nodes.begin()) - 1;
}

/// By which rounding may lead out of the table, radians.
constexpr double angle_slack = 1e-6;

/// ∫ sinγ f dγ for an f that goes linearly from f0 to f1.
double weighted_integral(double from, double to, double f0, double f1) {
  const double b = (f1 - f0) / (to - from), a = f0 - b * from;
  const auto antiderivative = [&](double angle) {
    return -(a + b * angle) * std::cos(angle) + b * std::sin(angle);
  };
  return antiderivative(to) - antiderivative(from);
}

}  // namespace

IntensityTable::IntensityTable(std::vector<double> turns, std::vector<double> angles,
                               std::vector<float> values)
    : turns_(std::move(turns)), angles_(std::move(angles)), values_(std::move(values)) {}

IntensityTable IntensityTable::times(float factor) const {
  IntensityTable result = *this;
  for (float& value : result.values_) value *= factor;
  return result;
}

float IntensityTable::value(const LatLong& at) const {
  const double angle = std::acos(std::clamp(at.height, -1.0, 1.0));
  if (angle < angles_.front() - angle_slack || angle > angles_.back() + angle_slack) return 0;
  const auto row = size_t(std::clamp(node_before(angles_, angle), 0, int(angles_.size()) - 2));
  const double t = std::clamp((angle - angles_[row]) / (angles_[row + 1] - angles_[row]), 0.0, 1.0);
  const int last = int(turns_.size()) - 1;
  const int before = node_before(turns_, at.turn);
  const int left = before < 0 ? last : before;
  const int right = left < last ? left + 1 : 0;
  double s = at.turn - turns_[size_t(left)], width = turns_[size_t(right)] - turns_[size_t(left)];
  if (before < 0) s += 1;
  if (right <= left) width += 1;
  s /= width;
  const auto at_row = [&](size_t r) {
    return std::lerp(double(node(r, size_t(left))), double(node(r, size_t(right))), s);
  };
  return float(std::max(0.0, std::lerp(at_row(row), at_row(row + 1), t)));
}

double IntensityTable::integral() const {
  // Each column stands for half of what is between it and its neighbours.
  std::vector<double> means(angles_.size());
  for (size_t c = 0; c < turns_.size(); ++c) {
    const double before = c > 0 ? turns_[c - 1] : turns_.back() - 1;
    const double after = c + 1 < turns_.size() ? turns_[c + 1] : turns_.front() + 1;
    for (size_t r = 0; r < angles_.size(); ++r)
      means[r] += double(node(r, c)) * 0.5 * (after - before);
  }
  double sum = 0;
  for (size_t r = 0; r + 1 < angles_.size(); ++r)
    sum += weighted_integral(angles_[r], angles_[r + 1], means[r], means[r + 1]);
  return std::max(0.0, 2 * std::numbers::pi * sum);
}

float IntensityTable::maximum() const { return *std::ranges::max_element(values_); }

LatLong IntensityTable::brightest() const {
  const auto at = size_t(std::ranges::max_element(values_) - values_.begin());
  return {turns_[at % turns_.size()], std::cos(angles_[at / turns_.size()])};
}

std::pair<double, double> IntensityTable::lit_angles() const {
  const auto is_dark = [&](size_t row) {
    for (size_t c = 0; c < turns_.size(); ++c)
      if (node(row, c) > 0) return false;
    return true;
  };
  size_t first = 0, last = angles_.size() - 1;
  while (first < angles_.size() && is_dark(first)) ++first;
  if (first == angles_.size()) return {0, 0};
  while (is_dark(last)) --last;
  return {angles_[first > 0 ? first - 1 : 0], angles_[std::min(last + 1, angles_.size() - 1)]};
}

// ---- sampling ----

namespace {

/// Of tables whose nodes lie on no even grid.
constexpr int usual_columns = 180, usual_steps = 180;
/// An even grid may have so many times the nodes of the table, or so many.
constexpr size_t most_refinement = 16, always_allowed = size_t{1} << 15;

/// How many even steps from 0 to `end` have all nodes among their ends; 0: none that is small.
int even_steps(const std::vector<double>& nodes, double end) {
  double gap = end;
  double before = 0;
  for (const double node : nodes) {
    if (node - before > 1e-9 * end) gap = std::min(gap, node - before);
    before = node;
  }
  if (end - before > 1e-9 * end) gap = std::min(gap, end - before);
  const double steps = end / gap;
  if (!(steps < 1e5)) return 0;
  const auto is_whole = [](double x) { return std::fabs(x - std::round(x)) < 1e-3; };
  if (!is_whole(steps)) return 0;
  for (const double node : nodes)
    if (!is_whole(node / gap)) return 0;
  return int(std::lround(steps));
}

/// Lines across a table: those of an even grid and its own, ascending.
struct Lines {
  std::vector<double> at;
  std::vector<size_t> of_grid;  ///< where the even ones stand, the end included

  Lines(const std::vector<double>& nodes, int steps, double end) {
    std::vector<double> even;
    for (int i = 0; i <= steps; ++i) even.push_back(end * i / steps);
    std::ranges::merge(even, nodes, std::back_inserter(at));
    at.erase(std::unique(at.begin(), at.end()), at.end());
    while (at.size() > 1 && at.back() > even.back()) at.pop_back();
    for (const double line : even)
      of_grid.push_back(size_t(std::ranges::lower_bound(at, line) - at.begin()));
  }
};

/// The largest of `values`, rows of lines, in the cells about a node of the grid. What is piecewise
/// bilinear has it where lines cross.
float largest_around(const std::vector<float>& values, const Lines& angles, const Lines& turns,
                     int row, int column) {
  const auto line = [](const Lines& lines, int i) {
    return lines.of_grid[size_t(std::clamp(i, 0, int(lines.of_grid.size()) - 1))];
  };
  const int columns = int(turns.of_grid.size()) - 1;
  float most = 0;
  const auto look = [&](int first, int last) {
    for (size_t r = line(angles, row - 1); r <= line(angles, row + 1); ++r)
      for (size_t c = line(turns, first); c <= line(turns, last); ++c)
        most = std::max(most, values[r * turns.at.size() + c]);
  };
  look(column - 1, column + 1);
  if (column == 0) look(columns - 1, columns);  // round the axis
  return most;
}

}  // namespace

/// An even grid for a table.
struct IntensitySampler::Grid {
  double first_turn = 0;  ///< of the first column
  int columns = 1, steps = 1;
  double last_angle = 0;
  std::vector<float> values;

  explicit Grid(const IntensityTable& table)
      : first_turn(table.turns().front()), last_angle(table.angles().back()) {
    std::vector<double> turns = table.turns();
    for (double& turn : turns) turn -= first_turn;
    const auto value = [&](double turn, double angle) {
      const double whole = first_turn + turn;
      return table.value({whole - std::floor(whole), std::cos(angle)});
    };
    if (has_even_nodes(table, turns)) {
      for (int row = 0; row <= steps; ++row)
        for (int column = 0; column < columns; ++column)
          values.push_back(value(double(column) / columns, last_angle * row / steps));
      return;
    }
    columns = usual_columns;
    steps = usual_steps;
    const Lines across(turns, columns, 1), down(table.angles(), steps, last_angle);
    std::vector<float> found;
    for (const double angle : down.at)
      for (const double turn : across.at) found.push_back(value(turn, angle));
    for (int row = 0; row <= steps; ++row)
      for (int column = 0; column < columns; ++column)
        values.push_back(largest_around(found, down, across, row, column));
  }

 private:
  /// Chooses a grid that has all nodes of the table, if one is small enough.
  bool has_even_nodes(const IntensityTable& table, const std::vector<double>& turns) {
    columns = even_steps(turns, 1);
    steps = even_steps(table.angles(), last_angle);
    if (columns == 0 || steps == 0) return false;
    steps *= int(std::ceil(last_angle / steps / widest_step - 1e-6));
    const size_t nodes = table.turns().size() * table.angles().size();
    return size_t(columns) * (size_t(steps) + 1) <=
           std::max(always_allowed, most_refinement * nodes);
  }
};

IntensitySampler::IntensitySampler(const IntensityTable& table) : IntensitySampler(Grid(table)) {}

/// Columns of the distribution stand at half steps.
IntensitySampler::IntensitySampler(const Grid& grid)
    : first_turn_(grid.first_turn - 0.5 / grid.columns),
      distribution_(grid.columns, grid.values, grid.last_angle) {}

}  // namespace kaustik
