#include "kaustik/loader/gltf/gltf_nodes.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <stdexcept>

namespace kaustik::gltf {
namespace {

/// A matrix that may collapse space; nothing where it leaves less than a plane or is not finite.
std::optional<Transform> transform_of(const double (&rows)[4][4]) {
  try {
    return Transform(rows);
  } catch (const std::invalid_argument&) {
  }
  try {
    const Transform flat = Transform::collapsing(rows);
    if (flat.dimensions() >= 2) return flat;
  } catch (const std::invalid_argument&) {
  }
  return std::nullopt;
}

/// Translation, rotation by a quaternion x y z w, and scale.
void compose(const std::vector<double>& t, std::vector<double> q, const std::vector<double>& s,
             double (&rows)[4][4]) {
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (length > 0)
    for (double& part : q) part /= length;
  else
    q = {0, 0, 0, 1};
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  const double rotation[3][3] = {
      {1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
      {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
      {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) rows[i][j] = rotation[i][j] * s[j];
    rows[i][3] = t[i];
  }
}

std::optional<Transform> local_transform(const File& file, const Pose& pose, const JsonValue& node,
                                         size_t index) {
  double rows[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  if (node.find("matrix")) {
    const std::vector<double> columns = file.numbers(node, "matrix", std::vector<double>(16));
    for (size_t i = 0; i < 3; ++i)
      for (size_t j = 0; j < 4; ++j) rows[i][j] = columns[4 * j + i];
  } else {
    const auto part = [&](Animated what, const char* name, std::vector<double> usual) {
      const std::vector<double>* moved = pose.find(index, what);
      return moved ? *moved : file.numbers(node, name, std::move(usual));
    };
    compose(part(Animated::translation, "translation", {0, 0, 0}),
            part(Animated::rotation, "rotation", {0, 0, 0, 1}),
            part(Animated::scale, "scale", {1, 1, 1}), rows);
  }
  return transform_of(rows);
}

std::optional<Transform> product(const Transform& parent, const Transform& own) {
  try {
    const Transform both = parent * own;
    if (both.dimensions() >= 2) return both;
  } catch (const std::invalid_argument&) {
  }
  return std::nullopt;
}

class NodeWalk {
 public:
  NodeWalk(const File& file, const Pose& pose, Deviations& deviations)
      : file_(file), pose_(pose), deviations_(deviations), is_known_(file.list("nodes").size()) {}

  std::vector<PlacedNode> walk() {
    for (std::vector<Open> open = roots(); !open.empty();) {
      const Open next = open.back();
      open.pop_back();
      visit(next, open);
    }
    return std::move(placed_);
  }

 private:
  /// A node that is still to be visited.
  struct Open {
    size_t index;
    const JsonValue* named_at;
    size_t parent;  ///< among those that are placed
  };
  static constexpr size_t no_parent = SIZE_MAX;

  std::vector<Open> roots() const {
    const JsonValue::Items& scenes = file_.list("scenes");
    if (!scenes.empty()) {
      const JsonValue* scene = file_.referred(file_.root(), "scene", "scenes");
      return children(scene ? *scene : scenes[0], "nodes", no_parent);
    }
    // Without a scene all are shown that are nobody's children.
    const JsonValue::Items& nodes = file_.list("nodes");
    std::vector<bool> is_child(nodes.size());
    for (const JsonValue& node : nodes)
      for (const Open& child : children(node, "children", no_parent)) is_child[child.index] = true;
    std::vector<Open> result;
    for (size_t i = nodes.size(); i-- > 0;)
      if (!is_child[i]) result.push_back({i, &nodes[i], no_parent});
    return result;
  }

  /// The last one first.
  std::vector<Open> children(const JsonValue& parent, const char* name, size_t index) const {
    std::vector<Open> result;
    const JsonValue* list = parent.find(name);
    if (!list) return result;
    for (size_t i = list->items().size(); i-- > 0;) {
      const JsonValue& item = list->items()[i];
      const auto child = item.number();
      if (!child || !(*child >= 0) || *child != std::floor(*child) || *child > 1e9)
        file_.fail(item, "this is no index of a node", "export the file again");
      file_.item("nodes", size_t(*child), item);
      result.push_back({size_t(*child), &item, index});
    }
    return result;
  }

  void visit(const Open& next, std::vector<Open>& open) {
    const JsonValue& node = file_.item("nodes", next.index, *next.named_at);
    if (is_known_[next.index])
      file_.fail(*next.named_at,
                 fmt::format("node {} has two parents, or is within itself", next.index),
                 "let each node be the child of one node");
    is_known_[next.index] = true;
    if (const JsonValue* visibility = file_.extension(node, "KHR_node_visibility"))
      if (!file_.boolean(*visibility, "visible", true)) return;
    PlacedNode placed = {&node, next.index};
    if (next.parent != no_parent) {
      placed.to_world = placed_[next.parent].to_world;
      placed.is_there = placed_[next.parent].is_there;
    }
    if (placed.is_there) {
      const std::optional<Transform> own = local_transform(file_, pose_, node, next.index);
      const std::optional<Transform> both = own ? product(placed.to_world, *own) : std::nullopt;
      if (both) placed.to_world = *both;
      placed.is_there = both.has_value();
      if (!both)
        deviations_.ignored(file_.name_of("node", node, next.index),
                            "its transform leaves less than a plane of space: it is left out, "
                            "with its children",
                            file_.place(node));
    }
    placed_.push_back(placed);
    for (const Open& child : children(node, "children", placed_.size() - 1)) open.push_back(child);
  }

  const File& file_;
  const Pose& pose_;
  Deviations& deviations_;
  std::vector<bool> is_known_;
  std::vector<PlacedNode> placed_;
};

}  // namespace

std::vector<PlacedNode> placed_nodes(const File& file, const Pose& pose, Deviations& deviations) {
  return NodeWalk(file, pose, deviations).walk();
}

}  // namespace kaustik::gltf
