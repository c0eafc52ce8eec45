#include "kaustik/vcm/light_path/block.h"

namespace kaustik {
namespace {

/// Where each block's `vertices` begin in the joint list.
std::vector<size_t> vertex_begins(const std::vector<LightBlock>& blocks) {
  std::vector<size_t> begins;
  size_t count = 0;
  for (const LightBlock& block : blocks) {
    begins.push_back(count);
    count += block.vertices.size();
  }
  return begins;
}

/// One list of all blocks as one, each element changed by `change(element, block)`. Takes it away
/// from the blocks, one by one: two of everything would be much memory. Of no use once stopped.
template <typename Element, typename Change>
std::vector<Element> joined(std::vector<LightBlock>& blocks, std::vector<Element> LightBlock::*list,
                            const std::stop_token& stop, const Change& change) {
  size_t count = 0;
  for (const LightBlock& block : blocks) count += (block.*list).size();
  std::vector<Element> result;
  result.reserve(count);
  // To touch so much memory takes longer than to copy it. Threads could share that only if all of
  // it were set to zero before, which is as much work and can't be stopped.
  for (size_t i = 0; i < blocks.size() && !stop.stop_requested(); ++i) {
    std::vector<Element>& from = blocks[i].*list;
    for (Element& element : from) change(element, i);
    result.insert(result.end(), from.begin(), from.end());
    from = {};
  }
  return result;
}

/// So that vertices of the list's neighbourhood are near one another.
MediumVertices in_order(const std::vector<DiscHierarchy::Disc>& discs,
                        const std::vector<MergeableMediumVertex>& data) {
  if (data.empty()) return {};
  std::vector<Vec3f> positions;
  positions.reserve(discs.size());
  for (const DiscHierarchy::Disc& disc : discs) positions.push_back(disc.center);
  const std::vector<uint32_t> order = order_in_space(positions);
  std::vector<DiscHierarchy::Disc> ordered(discs.size());
  MediumVertices result;
  result.data.resize(data.size());
  for (size_t i = 0; i < order.size(); ++i) {
    ordered[i] = discs[order[i]];
    result.data[i] = data[order[i]];
  }
  result.discs = DiscHierarchy(std::move(ordered));
  return result;
}

}  // namespace

GaugeVertices::GaugeVertices(const std::vector<GaugeVertex>& vertices, size_t gauges,
                             const GaugeDisks& disks)
    : vertices_(vertices.size()), begins_(gauges + 1), disks_(&disks) {
  for (const GaugeVertex& vertex : vertices) ++begins_[vertex.gauge + 1];
  for (size_t i = 0; i < gauges; ++i) begins_[i + 1] += begins_[i];
  std::vector<size_t> next(begins_.begin(), begins_.end() - 1);
  for (const GaugeVertex& vertex : vertices) vertices_[next[vertex.gauge]++] = vertex;
}

LightVertices join(std::vector<LightBlock>& blocks, size_t gauges, const GaugeDisks* disks,
                   const std::stop_token& stop) {
  const std::vector<size_t> begins = vertex_begins(blocks);
  const auto as_it_is = [](const auto&, size_t) {};
  const auto of_whole = [&](auto& element, size_t block) {
    element.path += uint32_t(begins[block]);
  };
  LightVertices result;
  result.vertices = joined(blocks, &LightBlock::vertices, stop, as_it_is);
  result.connectible =
      joined(blocks, &LightBlock::connectible, stop,
             [&](ConnectibleVertex& vertex, size_t block) { of_whole(vertex.data, block); });
  result.beginnings = joined(blocks, &LightBlock::beginnings, stop, of_whole);
  result.scatterings = joined(blocks, &LightBlock::scatterings, stop, of_whole);
  std::vector<DiscHierarchy::Disc> discs = joined(blocks, &LightBlock::discs, stop, as_it_is);
  std::vector<MergeableMediumVertex> in_media =
      joined(blocks, &LightBlock::in_media, stop, of_whole);
  std::vector<GaugeVertex> at_gauges =
      joined(blocks, &LightBlock::at_gauges, stop,
             [&](GaugeVertex& vertex, size_t block) { of_whole(vertex.data, block); });
  std::vector<Vec3f> positions = joined(blocks, &LightBlock::positions, stop, as_it_is);
  std::vector<LightVertexData> data = joined(blocks, &LightBlock::data, stop, of_whole);
  // Nobody will look at it: to put it in order takes the most time.
  if (stop.stop_requested()) return {};
  blocks.clear();
  result.in_media = in_order(discs, in_media);
  if (disks) result.at_gauges = {at_gauges, gauges, *disks};
  if (!data.empty()) result.tree = {std::move(positions), std::move(data), stop};
  return result;
}

}  // namespace kaustik
