#include "kaustik/vcm/light_vertices.h"

namespace kaustik {

SidedTree<LightVertexData> focused_vertices(const LightVertices& light,
                                            const std::stop_token& stop) {
  const auto& tree = light.tree.tree();
  const std::span<const LightVertexData> all = tree.data();
  std::vector<Vec3f> positions;
  std::vector<LightVertexData> focused;
  for (size_t i = 0; i < all.size(); ++i) {
    if (!all[i].specular) continue;
    positions.push_back(tree.key(uint32_t(i)));
    focused.push_back(all[i]);
  }
  if (focused.empty()) return {};
  return {std::move(positions), std::move(focused), stop};
}

}  // namespace kaustik
