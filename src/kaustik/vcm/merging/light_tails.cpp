#include "kaustik/vcm/merging/light_tails.h"

#include "kaustik/base/parallel.h"

namespace kaustik {
namespace {

PathWeights::LightTail tail_of(const LightVertices& light, const LightVertexData& data,
                               const PathWeights& weights,
                               std::vector<PathWeights::LaterMerge>& merges) {
  static constexpr PathVertex any_vertex{};
  const PathVertex& vertex = light.at(data);
  PathHalves path;
  path.camera = {&any_vertex, 1};
  path.light = light.before(data);
  path.pdf_light_last = vertex.pdf_light;
  path.pdf_camera_last = vertex.to_previous;
  path.pdf_camera_before_last = path.light[path.light.size() - 2].pdf_camera;
  path.pdf_next_event = data.pdf_next_event;
  return weights.light_tail(path, merges);
}

}  // namespace

LightTails::LightTails(const LightVertices& light, const PathWeights& weights,
                       const std::stop_token& stop)
    : tails_(light.tree.tree().size()), merges_((tails_.size() + block_size - 1) / block_size) {
  parallel_blocks(tails_.size(), block_size, [&](size_t begin, size_t end, size_t block) {
    for (size_t i = begin; i < end && !stop.stop_requested(); ++i)
      tails_[i] = tail_of(light, light.tree.tree().data(uint32_t(i)), weights, merges_[block]);
  });
}

}  // namespace kaustik
