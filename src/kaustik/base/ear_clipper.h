#pragma once
// Cuts ears off polygons; for PolygonCutter.

#include <array>
#include <cstdint>
#include <vector>

#include "kaustik/base/vec.h"

namespace kaustik {

using Vec2d = Imath::Vec2<double>;

/// 1 if `c` lies to the left of the line from `a` to `b`, −1 to the right, 0 on it; exact as long
/// as coordinates do not differ by more than floats can.
int side_of(const Vec2d& a, const Vec2d& b, const Vec2d& c);

/// Triangulates by ears (Meisters, "Polygons Have Ears", The American Mathematical Monthly 1975):
/// a corner is cut off if no other corner lies in the way. Those that may are found in a tree, so
/// that n corners usually take n log n steps.
class EarClipper {
 public:
  /// Each step is taken from `steps`, which must outlive this as `points` must.
  EarClipper(const std::vector<Vec2d>& points, size_t& steps);

  /// False if the steps are spent; then triangles are missing.
  [[nodiscard]] bool clip();
  const std::vector<std::array<uint32_t, 3>>& triangles() const { return triangles_; }

 private:
  /// Of the tree over the corners that may be in the way.
  struct Node {
    Vec2d low, high;
    uint32_t begin, end;                   ///< of items_
    uint32_t parent, left = 0, right = 0;  ///< left 0: a leaf
    uint32_t alive;                        ///< items that may still be in the way
  };

  int side(uint32_t a, uint32_t b, uint32_t c) const {
    return front_ * side_of(points_[a], points_[b], points_[c]);
  }
  int turn_at(uint32_t v) const { return side(previous_[v], v, next_[v]); }
  bool folds_back(uint32_t v) const;
  void enqueue(uint32_t v);
  void enqueue_all();
  void cut_off(uint32_t v);
  /// Cuts off what it can of the queue and what that makes possible; `checked`: only ears.
  bool work(bool checked);

  void build_tree();
  uint32_t build_node(uint32_t begin, uint32_t end, uint32_t parent);
  void forget(uint32_t v);
  bool is_blocked(uint32_t v);
  using Ear = std::array<uint32_t, 3>;
  double extent() const;
  bool blocks(uint32_t w, const Ear& ear) const;
  bool is_outside(const Vec2d& p, uint32_t a, uint32_t b) const;
  bool outside_meets(uint32_t w, uint32_t q, uint32_t r, uint32_t s) const;
  bool may_reach(const Node& node, const Ear& ear) const;

  const std::vector<Vec2d>& points_;
  size_t& steps_;
  int front_ = 1;  ///< −1 while lobes that run clockwise are cut
  double tolerance_ = 0;
  uint32_t first_ = 0;
  size_t left_;
  std::vector<uint32_t> previous_, next_, queue_;
  std::vector<uint8_t> queued_, gone_;
  size_t queue_head_ = 0;
  std::vector<Node> nodes_;
  std::vector<uint32_t> items_, leaf_of_;
  std::vector<std::array<uint32_t, 3>> triangles_;
};

}  // namespace kaustik
