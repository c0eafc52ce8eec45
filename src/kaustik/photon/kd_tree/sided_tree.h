#pragma once
#include "kaustik/photon/kd_tree/kd_tree.h"
#include "kaustik/photon/kd_tree/photon_sides.h"
#include "kaustik/photon/photon.h"

namespace kaustik {

/// A kd-tree over things that lie on surfaces, each on one side of its own: photons of every kind,
/// and places. The one answer to "does this photon count here": searches reject during the search
/// what lies on the other side. `Data` has a CoarseNormal `side` (geometric normal on its side) and
/// `on_front` (whether that is the side of the surface's own normal). Immutable; searches are
/// thread-safe.
template <typename Data>
class SidedTree {
 public:
  using Tree = KdTree<3, Vec3f, Data>;
  using Neighbors = typename Tree::Neighbors;

  SidedTree() = default;
  /// Where `stop` is requested the tree is left empty.
  SidedTree(std::vector<Vec3f> positions, std::vector<Data> data,
            const std::stop_token& stop = {}) {
    tree_.assign(std::move(positions), std::move(data), stop);
    sides_.reserve(tree_.size());
    for (const Data& d : tree_.data())
      sides_.add(d.side.x(), d.side.y(), d.side.z(), d.on_front != 0);
  }

  /// A tree that was built before, and the sides of its items in its order.
  SidedTree(Tree tree, PhotonSides sides) : tree_(std::move(tree)), sides_(std::move(sides)) {}

  const Tree& tree() const { return tree_; }
  const PhotonSides& sides() const { return sides_; }
  size_t size() const { return tree_.size(); }
  bool empty() const { return tree_.empty(); }
  size_t size_in_bytes() const { return tree_.size_in_bytes() + sides_.size_in_bytes(); }

  /// The nearest `count` within `maximum_radius` on the side of `normal` (geometric), or
  /// (`both_sides`, where light passes through) on either side of surfaces whose own normal lies in
  /// the half space of `normal`.
  void nearest(const Vec3f& position, const Vec3f& normal, bool both_sides, int count,
               float maximum_radius, Neighbors& neighbors) const {
    const PhotonSides::Query query = PhotonSides::query(normal, both_sides);
    const auto accept = [&](uint32_t first, uint32_t mask) {
      return sides_.accept(query, first, mask);
    };
    tree_.nearest(position, size_t(count), sqr(maximum_radius), accept, neighbors);
  }

  /// Calls visit(index, distance_sq) for all that nearest() would find within the radius.
  template <typename Visit>
  void within(const Vec3f& position, const Vec3f& normal, bool both_sides, float radius_sq,
              const Visit& visit) const {
    const PhotonSides::Query query = PhotonSides::query(normal, both_sides);
    tree_.within(position, radius_sq, [&](uint32_t index, float distance_sq) {
      if (sides_.accepts(query, index)) visit(index, distance_sq);
    });
  }

  /// Distance within which the `neighbors` nearest of an item on its side lie, itself among them,
  /// at the share `quantile` of the items, by some hundreds of probes. Where an item has fewer, the
  /// farthest of those counts; infinite if there are none, or if the distance comes out as zero.
  float typical_radius(int neighbors, float quantile) const {
    constexpr size_t probes = 512;
    if (empty() || neighbors <= 0) return infinity;
    std::vector<float> radii;
    Neighbors found;
    float reach = 0;
    for (size_t i = 0; i < probes; ++i) {
      const auto index = uint32_t(i * size() / probes);
      const Vec3f side = tree_.data(index).side.unpack();
      // Without a limit a search may come through much that lies on other sides.
      constexpr int most_tries = 8;
      for (int tries = 1;; ++tries, reach *= 2) {
        if (tries == most_tries || !(reach > 0)) reach = infinity;
        nearest(tree_.key(index), side, false, neighbors, reach, found);
        if (found.size() == size_t(neighbors) || reach == infinity) break;
      }
      radii.push_back(std::sqrt(found.farthest_sq()));
      reach = 2 * radii.back();
    }
    const auto at = radii.begin() + std::ptrdiff_t(float(radii.size()) * quantile);
    std::nth_element(radii.begin(), at, radii.end());
    return *at > 0 ? *at : infinity;
  }

 private:
  Tree tree_;
  PhotonSides sides_;  ///< in the tree's order
};

}  // namespace kaustik
