#include "kaustik/vcm/lessons/guide_square.h"

#include <algorithm>
#include <numeric>

namespace kaustik {
namespace {

constexpr int most_levels = 12;
/// A cell is divided from so many points on, and so large a part of all.
constexpr size_t least_points = 32;
constexpr size_t most_parts = 512;
/// What is known of a cell counts as so many points in each of its quarters.
constexpr double points_of_parent = 0.5;

}  // namespace

GuideSquare::GuideSquare(std::vector<Point> points) {
  const double weight =
      std::accumulate(points.begin(), points.end(), 0.0,
                      [](double sum, const Point& point) { return sum + point.weight; });
  nodes_.emplace_back();
  const size_t most = std::max(least_points, points.size() / most_parts);
  const double root = build(0, {points.begin(), points.end(), {0, 0}, 1}, weight, 0, most);
  expected_sum_ = root * root;
  set_densities(0, 1);
}

/// Returns Σ √(weight × area) over the leaves. `weight` of all points, leaned on what is known of
/// the cell around.
double GuideSquare::build(uint32_t node, const Range& range, double weight, int depth,
                          size_t most) {
  const auto count = size_t(range.end - range.begin);
  // Until set_densities: its √(weight × area).
  const double own = std::sqrt(weight) * double(range.size);
  if (count < most || depth == most_levels || !(weight > 0)) return own;
  const float half = 0.5f * range.size;
  const Vec2f middle = range.corner + Vec2f(half, half);
  const auto is_left = [&](const Point& p) { return p.u.x < middle.x; };
  const auto is_low = [&](const Point& p) { return p.u.y < middle.y; };
  // In the given order, so that sums are the same on every machine.
  const Points center = std::stable_partition(range.begin, range.end, is_left);
  const Points left = std::stable_partition(range.begin, center, is_low);
  const Points right = std::stable_partition(center, range.end, is_low);
  const Range quarters[] = {{range.begin, left, range.corner, half},
                            {left, center, {range.corner.x, middle.y}, half},
                            {center, right, {middle.x, range.corner.y}, half},
                            {right, range.end, middle, half}};
  std::array<double, 4> weights{};
  double sum = 0;
  for (size_t i = 0; i < 4; ++i) {
    for (Points p = quarters[i].begin; p != quarters[i].end; ++p) weights[i] += p->weight;
    sum += weights[i];
  }
  if (!(sum > 0)) return own;
  const double leaned = 4 * points_of_parent / (double(count) + 4 * points_of_parent);
  const auto first = uint32_t(nodes_.size());
  nodes_.resize(nodes_.size() + 4);
  std::array<double, 4> roots{};
  for (size_t i = 0; i < 4; ++i) {
    const double of_quarter = weight * ((1 - leaned) * weights[i] / sum + 0.25 * leaned);
    roots[i] = build(first + uint32_t(i), quarters[i], of_quarter, depth + 1, most);
  }
  const double total = roots[0] + roots[1] + roots[2] + roots[3];
  Node& here = nodes_[node];
  here.children = first;
  // The random numbers have 24 bits.
  const auto share = [](double part, double of) {
    return float(std::round(part / of * 0x1p24) * 0x1p-24);
  };
  here.left = share(roots[0] + roots[1], total);
  here.lower[0] = share(roots[0], roots[0] + roots[1]);
  here.lower[1] = share(roots[2], roots[2] + roots[3]);
  return total;
}

void GuideSquare::set_densities(uint32_t node, double density) {
  const Node here = nodes_[node];
  if (here.children == 0) {
    nodes_[node].density = float(density);
    return;
  }
  const double sides[] = {double(here.left), 1 - double(here.left)};
  for (uint32_t side = 0; side < 2; ++side) {
    const double low = double(here.lower[side]);
    set_densities(here.children + 2 * side, 4 * density * sides[side] * low);
    set_densities(here.children + 2 * side + 1, 4 * density * sides[side] * (1 - low));
  }
}

Vec2f GuideSquare::sample(Vec2f u) const {
  Vec2f corner(0, 0);
  float size = 1;
  // Of two halves the first, of which `share` of the numbers are, or the second.
  const auto halve = [](float& number, float share) {
    const bool second = number >= share;
    number = second ? (number - share) / (1 - share) : number / share;
    number = std::min(number, one_minus_epsilon);
    return second ? 1u : 0u;
  };
  const Node* node = nodes_.data();
  while (node->children != 0) {
    size *= 0.5f;
    const uint32_t right = halve(u.x, node->left);
    const uint32_t upper = halve(u.y, node->lower[right]);
    corner += Vec2f(float(right), float(upper)) * size;
    node = &nodes_[node->children + 2 * right + upper];
  }
  return {std::min(corner.x + u.x * size, one_minus_epsilon),
          std::min(corner.y + u.y * size, one_minus_epsilon)};
}

float GuideSquare::pdf(const Vec2f& u) const {
  if (!(u.x >= 0 && u.y >= 0 && u.x < 1 && u.y < 1)) return 0;
  const Node* node = nodes_.data();
  float x = u.x, y = u.y;
  while (node->children != 0) {
    x *= 2;
    y *= 2;
    const uint32_t right = x >= 1 ? 1 : 0, upper = y >= 1 ? 1 : 0;
    x -= float(right);
    y -= float(upper);
    node = &nodes_[node->children + 2 * right + upper];
  }
  return node->density;
}

void GuideSquare::write(ByteWriter& writer) const {
  writer.put_array(nodes_);
  writer.put(expected_sum_);
}

GuideSquare GuideSquare::read(ByteReader& reader) {
  GuideSquare result;
  result.nodes_ = reader.get_array<Node>();
  result.expected_sum_ = reader.get<double>();
  if (result.nodes_.empty()) reader.damaged("a guide in it is empty");
  for (size_t i = 0; i < result.nodes_.size(); ++i) {
    // Children come after their parent, so that every way down ends.
    const uint64_t first = result.nodes_[i].children;
    if (first != 0 && (first <= i || first + 4 > result.nodes_.size()))
      reader.damaged("a guide in it is no tree");
  }
  return result;
}

}  // namespace kaustik
