#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "kaustik/photon/photon_map.h"
#include "kaustik/photon/photon_sort.h"

namespace kaustik {

/// The arrays that a tree of photons consists of.
enum class TreePart { buckets, nodes, photons, sides };
/// Bytes of an item, which no item leaves unset.
size_t item_bytes(TreePart part);
/// Items in a tree of so many photons.
uint64_t item_count(TreePart part, size_t photons);

/// Gets items of a part, from item `first` on.
using TakeItems =
    std::function<void(TreePart part, uint64_t first, std::span<const uint8_t> items)>;

/// Builds a tree of all photons of `sort`, of which there are `count`, piece by piece: only some
/// hundred thousand of them are in memory at a time, beside what `sort` keeps. The tree depends on
/// nothing but the photons. Within a piece, a subtree whose levels are full, photons are divided at
/// medians; pieces follow one another along the curve of their order. Returns the mean over photons
/// of the largest lane of flux, W.
float build_photon_tree(PhotonSort& sort, size_t count, const TakeItems& take);

/// The same tree in memory.
class BuiltPhotonTree {
 public:
  BuiltPhotonTree(PhotonSort& sort, size_t count);
  PhotonMap map() &&;

 private:
  size_t count_;
  std::vector<KdBuckets::Bucket> buckets_;
  std::vector<KdBuckets::Node> nodes_;
  std::vector<Photon> photons_;
  std::vector<PhotonSides::Block> sides_;
  float mean_flux_;
};

}  // namespace kaustik
