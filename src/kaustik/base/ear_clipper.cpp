#include "kaustik/base/ear_clipper.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace kaustik {
namespace {

constexpr uint32_t nowhere = std::numeric_limits<uint32_t>::max();

}  // namespace

int side_of(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  const double ux = b.x - a.x, uy = b.y - a.y, vx = c.x - a.x, vy = c.y - a.y;
  const double l = ux * vy, r = uy * vx;
  double det = l - r;
  if (!(std::fabs(det) > 4 * std::numeric_limits<double>::epsilon() * std::fabs(l)))
    det += std::fma(ux, vy, -l) - std::fma(uy, vx, -r);  // what the products have lost
  return det > 0 ? 1 : det < 0 ? -1 : 0;
}

EarClipper::EarClipper(const std::vector<Vec2d>& points, size_t& steps)
    : points_(points),
      steps_(steps),
      left_(points.size()),
      previous_(points.size()),
      next_(points.size()),
      queued_(points.size(), 0),
      gone_(points.size(), 0),
      leaf_of_(points.size(), nowhere) {
  const auto n = uint32_t(points.size());
  for (uint32_t i = 0; i < n; ++i) {
    next_[i] = i + 1 < n ? i + 1 : 0;
    previous_[i] = i > 0 ? i - 1 : n - 1;
  }
  triangles_.reserve(points.size() - 2);
}

bool EarClipper::clip() {
  // Corners that touch sides may stand a little beyond them by rounding: such are left room first.
  const double rounding = 1e-6 * extent();
  for (size_t left_before = 0; left_ > 3 && left_ != left_before;) {
    left_before = left_;
    for (const auto& [front, tolerance] : {std::pair(1, rounding), {1, 0.0}, {-1, 0.0}}) {
      front_ = front;
      tolerance_ = tolerance;
      build_tree();
      enqueue_all();
      if (!work(true)) return false;
    }
  }
  // Without an ear on either side: sides cross.
  front_ = 1;
  build_tree();
  enqueue_all();
  if (!work(false)) return false;
  while (left_ > 3) cut_off(next_[first_]);
  triangles_.push_back({previous_[first_], first_, next_[first_]});
  return true;
}

/// The largest coordinate.
double EarClipper::extent() const {
  double largest = 0;
  for (const Vec2d& p : points_) largest = std::max({largest, std::fabs(p.x), std::fabs(p.y)});
  return largest;
}

bool EarClipper::work(bool checked) {
  while (queue_head_ < queue_.size() && left_ > 3) {
    const uint32_t v = queue_[queue_head_++];
    queued_[v] = 0;
    if (gone_[v]) continue;
    const bool convex = turn_at(v) > 0;
    if (folds_back(v) || (convex && !(checked && is_blocked(v)))) cut_off(v);
    if (steps_ == 0) return false;
    --steps_;
  }
  return true;
}

/// Also where it stays in place.
bool EarClipper::folds_back(uint32_t v) const {
  const Vec2d &p = points_[previous_[v]], &n = points_[next_[v]];
  return turn_at(v) == 0 && (p - points_[v]).dot(n - points_[v]) >= 0;
}

void EarClipper::enqueue(uint32_t v) {
  if (queued_[v]) return;
  queued_[v] = 1;
  queue_.push_back(v);
}

void EarClipper::enqueue_all() {
  queue_.clear();
  queue_head_ = 0;
  std::fill(queued_.begin(), queued_.end(), uint8_t(0));
  for (size_t i = 0; i < left_; ++i, first_ = next_[first_]) enqueue(first_);
}

void EarClipper::cut_off(uint32_t v) {
  const uint32_t p = previous_[v], n = next_[v];
  triangles_.push_back({p, v, n});
  next_[p] = n;
  previous_[n] = p;
  gone_[v] = 1;
  --left_;
  first_ = n;
  forget(v);
  for (const uint32_t neighbor : {p, n}) {
    if (turn_at(neighbor) > 0) forget(neighbor);
    enqueue(neighbor);
  }
}

/// Only corners that are not convex can be in the way: they are in the tree.
void EarClipper::build_tree() {
  items_.clear();
  nodes_.clear();
  std::fill(leaf_of_.begin(), leaf_of_.end(), nowhere);
  for (size_t i = 0; i < left_; ++i, first_ = next_[first_])
    if (turn_at(first_) <= 0) items_.push_back(first_);
  if (!items_.empty()) build_node(0, uint32_t(items_.size()), nowhere);
  steps_ -= std::min(steps_, 8 * left_);
}

uint32_t EarClipper::build_node(uint32_t begin, uint32_t end, uint32_t parent) {
  const auto index = uint32_t(nodes_.size());
  Node node{points_[items_[begin]], points_[items_[begin]], begin, end, parent, 0, 0, end - begin};
  for (uint32_t i = begin; i < end; ++i)
    for (int axis = 0; axis < 2; ++axis) {
      node.low[axis] = std::min(node.low[axis], points_[items_[i]][axis]);
      node.high[axis] = std::max(node.high[axis], points_[items_[i]][axis]);
    }
  nodes_.push_back(node);
  if (end - begin <= 8) {
    for (uint32_t i = begin; i < end; ++i) leaf_of_[items_[i]] = index;
    return index;
  }
  const int axis = node.high.x - node.low.x > node.high.y - node.low.y ? 0 : 1;
  const uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(items_.begin() + begin, items_.begin() + middle, items_.begin() + end,
                   [&](uint32_t a, uint32_t b) { return points_[a][axis] < points_[b][axis]; });
  const uint32_t left = build_node(begin, middle, index), right = build_node(middle, end, index);
  nodes_[index].left = left;
  nodes_[index].right = right;
  return index;
}

/// It will never be in the way again.
void EarClipper::forget(uint32_t v) {
  for (uint32_t i = leaf_of_[v]; i != nowhere; i = nodes_[i].parent) --nodes_[i].alive;
  leaf_of_[v] = nowhere;
}

bool EarClipper::is_blocked(uint32_t v) {
  if (nodes_.empty()) return false;
  const Ear ear = {previous_[v], v, next_[v]};
  std::array<uint32_t, 64> pending;
  size_t count = 0;
  pending[count++] = 0;
  while (count > 0) {
    const Node& node = nodes_[pending[--count]];
    steps_ -= std::min<size_t>(steps_, 1);
    if (node.alive == 0 || !may_reach(node, ear)) continue;
    if (node.left != 0) {
      pending[count++] = node.left;
      pending[count++] = node.right;
      continue;
    }
    steps_ -= std::min<size_t>(steps_, node.end - node.begin);
    for (uint32_t i = node.begin; i < node.end; ++i)
      if (leaf_of_[items_[i]] != nowhere && blocks(items_[i], ear)) return true;
  }
  return false;
}

/// False if all of the node's box lies to the right of a side of the ear.
bool EarClipper::may_reach(const Node& node, const Ear& ear) const {
  for (size_t i = 0; i < 3; ++i) {
    const Vec2d &a = points_[ear[i]], &b = points_[ear[(i + 1) % 3]];
    // (x, y) points to the left.
    const double x = -(b.y - a.y) * front_, y = (b.x - a.x) * front_;
    const double l = x * ((x > 0 ? node.high.x : node.low.x) - a.x);
    const double r = y * ((y > 0 ? node.high.y : node.low.y) - a.y);
    const double slack = 1e-12 * (std::fabs(l) + std::fabs(r)) + tolerance_ * std::hypot(x, y);
    if (l + r < -slack) return false;
  }
  return true;
}

/// Whether corner `w` lies in the closed triangle, or nearer to it than the tolerance; one at the
/// same place as a corner of the ear is in the way only if what is outside of it is inside the ear.
bool EarClipper::blocks(uint32_t w, const Ear& ear) const {
  if (w == ear[0] || w == ear[1] || w == ear[2]) return false;
  for (size_t i = 0; i < 3; ++i)
    if (is_outside(points_[w], ear[i], ear[(i + 1) % 3])) return false;
  for (size_t i = 0; i < 3; ++i)
    if ((points_[w] - points_[ear[i]]).length2() <= tolerance_ * tolerance_)
      return outside_meets(w, ear[i], ear[(i + 1) % 3], ear[(i + 2) % 3]);
  return true;
}

/// Whether `p` lies to the right of the line from `a` to `b`, by more than the tolerance.
bool EarClipper::is_outside(const Vec2d& p, uint32_t a, uint32_t b) const {
  if (tolerance_ == 0) return front_ * side_of(points_[a], points_[b], p) < 0;
  const Vec2d along = points_[b] - points_[a];
  return front_ * along.cross(p - points_[a]) < -tolerance_ * along.length();
}

/// Whether the wedge outside of corner `w`, which lies at `q`, and the wedge from `r` to `s` there,
/// which is less than half a turn, overlap.
bool EarClipper::outside_meets(uint32_t w, uint32_t q, uint32_t r, uint32_t s) const {
  const uint32_t from = previous_[w], to = next_[w];
  const auto within = [&](uint32_t x, uint32_t begin, uint32_t end) {
    return side(q, begin, x) > 0 && side(q, x, end) > 0;
  };
  const auto same_way = [&](uint32_t a, uint32_t b) {
    return side(q, a, b) == 0 && (points_[a] - points_[q]).dot(points_[b] - points_[q]) > 0;
  };
  if (within(from, r, s) || within(to, r, s)) return true;
  if (turn_at(w) == 0) return !folds_back(w) && (side(from, to, r) < 0 || side(from, to, s) < 0);
  return within(r, from, to) || within(s, from, to) || (same_way(from, r) && same_way(to, s));
}

}  // namespace kaustik
