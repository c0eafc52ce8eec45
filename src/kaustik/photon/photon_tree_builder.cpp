#include "kaustik/photon/photon_tree_builder.h"

#include <cstring>
#include <utility>

#include "kaustik/base/bytes.h"

namespace kaustik {
namespace {

using Node = KdBuckets::Node;

/// Levels of a piece, the last of which has one node.
constexpr size_t piece_levels = 5;
/// Photons in a piece that is full: what a node of its last level holds.
constexpr size_t piece_photons = [] {
  size_t count = KdBuckets::bucket_size;
  for (size_t level = 0; level < piece_levels; ++level) count *= KdBuckets::fan_out;
  return count;
}();

/// Takes a tree's pieces in their order.
class Builder {
 public:
  Builder(size_t count, const TakeItems& take)
      : begins_(KdBuckets::level_begins(count)), take_(take) {}

  void add(std::span<const PhotonRecord> records) {
    std::vector<Vec3f> positions(records.size());
    for (size_t i = 0; i < records.size(); ++i) positions[i] = records[i].position();
    KdBuckets piece;
    const std::vector<uint32_t> order = piece.build(positions);
    std::vector<Photon> photons(records.size());
    PhotonSides sides;
    sides.reserve(records.size());
    for (size_t i = 0; i < records.size(); ++i) {
      const Photon& photon = photons[i] = records[order[i]].photon;
      sides.add(photon.side.x(), photon.side.y(), photon.side.z(), photon.on_front != 0);
      flux_ += photon.flux.spectrum().max_lane();
    }
    take_(TreePart::buckets, first_ / KdBuckets::bucket_size, bytes_in(piece.buckets()));
    take_(TreePart::photons, first_, bytes_in(std::span<const Photon>(photons)));
    take_(TreePart::sides, first_ / PhotonSides::block_size, bytes_in(sides.blocks()));
    add_nodes(piece);
    first_ += records.size();
  }

  /// The levels above those of pieces; after the last piece.
  void finish() {
    std::vector<Node> below = std::move(tops_);
    for (size_t level = piece_levels; level < level_count(); ++level) {
      std::vector<Node> nodes;
      for (size_t first = 0; first < below.size(); first += KdBuckets::fan_out)
        nodes.push_back(KdBuckets::node_above(std::span(below).subspan(
            first, std::min<size_t>(KdBuckets::fan_out, below.size() - first))));
      take_(TreePart::nodes, begins_[level], bytes_in(std::span<const Node>(nodes)));
      below = std::move(nodes);
    }
  }

  double flux() const { return flux_; }

 private:
  size_t level_count() const { return begins_.size() - 1; }

  void add_nodes(const KdBuckets& piece) {
    const std::vector<size_t> begins = KdBuckets::level_begins(piece.size());
    size_t first = first_ / KdBuckets::bucket_size;
    std::span<const Node> nodes;
    Node top;
    for (size_t level = 0; level < std::min(piece_levels, level_count()); ++level) {
      first /= KdBuckets::fan_out;
      if (level + 1 < begins.size()) {
        nodes = piece.nodes().subspan(begins[level], begins[level + 1] - begins[level]);
      } else {
        // The last piece may be so small that it has fewer levels.
        top = KdBuckets::node_above(nodes);
        nodes = {&top, 1};
      }
      take_(TreePart::nodes, begins_[level] + first, bytes_in(nodes));
    }
    if (level_count() > piece_levels) tops_.push_back(nodes.front());
  }

  std::vector<size_t> begins_;
  const TakeItems& take_;
  std::vector<Node> tops_;  ///< the last nodes of pieces
  size_t first_ = 0;        ///< photons that were taken
  double flux_ = 0;
};

}  // namespace

size_t item_bytes(TreePart part) {
  switch (part) {
    case TreePart::buckets:
      return sizeof(KdBuckets::Bucket);
    case TreePart::nodes:
      return sizeof(Node);
    case TreePart::photons:
      return sizeof(Photon);
    case TreePart::sides:
      break;
  }
  return sizeof(PhotonSides::Block);
}

uint64_t item_count(TreePart part, size_t photons) {
  switch (part) {
    case TreePart::buckets:
      return KdBuckets::bucket_count_of(photons);
    case TreePart::nodes:
      return KdBuckets::level_begins(photons).back();
    case TreePart::photons:
      return photons;
    case TreePart::sides:
      break;
  }
  return PhotonSides::block_count(photons);
}

float build_photon_tree(PhotonSort& sort, size_t count, const TakeItems& take) {
  if (count == 0) return 0;
  Builder builder(count, take);
  sort.drain(piece_photons, [&](std::span<const PhotonRecord> records) { builder.add(records); });
  builder.finish();
  return float(builder.flux() / double(count));
}

BuiltPhotonTree::BuiltPhotonTree(PhotonSort& sort, size_t count)
    : count_(count),
      buckets_(item_count(TreePart::buckets, count)),
      nodes_(item_count(TreePart::nodes, count)),
      photons_(count),
      sides_(item_count(TreePart::sides, count)) {
  const auto begin_of = [this](TreePart part) -> void* {
    switch (part) {
      case TreePart::buckets:
        return buckets_.data();
      case TreePart::nodes:
        return nodes_.data();
      case TreePart::photons:
        return photons_.data();
      case TreePart::sides:
        break;
    }
    return sides_.data();
  };
  mean_flux_ = build_photon_tree(
      sort, count, [&](TreePart part, uint64_t first, std::span<const uint8_t> items) {
        std::memcpy(static_cast<uint8_t*>(begin_of(part)) + first * item_bytes(part), items.data(),
                    items.size());
      });
}

PhotonMap BuiltPhotonTree::map() && {
  KdBuckets buckets =
      KdBuckets::of(count_, KeptArray(std::move(buckets_)), KeptArray(std::move(nodes_)));
  return {SidedTree<Photon>({std::move(buckets), KeptArray(std::move(photons_))},
                            PhotonSides(KeptArray(std::move(sides_)))),
          mean_flux_};
}

}  // namespace kaustik
