#include "kaustik/loader/gltf/gltf_deformation.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace kaustik::gltf {
namespace {

using Matrix = std::array<float, 12>;

std::vector<double> weights_of(const File& file, const JsonValue& owner) {
  std::vector<double> weights;
  const JsonValue* list = owner.find("weights");
  if (!list) return weights;
  for (const JsonValue& item : list->items()) {
    const auto weight = item.number();
    if (!weight) file.fail(item, "this is no weight", "give a number");
    weights.push_back(*weight);
  }
  return weights;
}

/// The world's matrix times the inverse bind matrix, which lies by columns.
Matrix joint_matrix(const Transform& world, std::span<const float> bind) {
  Matrix matrix{};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) {
      double sum = 0;
      for (int k = 0; k < 4; ++k) sum += world.at(row, k) * double(bind[size_t(4 * column + k)]);
      matrix[size_t(4 * row + column)] = float(sum);
    }
  return matrix;
}

constexpr float identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

std::vector<Matrix> joints_of(File& file, Accessors& accessors, const JsonValue& skin,
                              const NodeWorlds& worlds) {
  const JsonValue* joints = skin.find("joints");
  if (!joints) return {};
  file.spend(joints->items().size() * sizeof(Matrix), skin);
  std::shared_ptr<const Array> binds;
  if (const auto index = file.count(skin, "inverseBindMatrices")) {
    binds = accessors.floats(*index, skin);
    if (binds->extents()[1] != 16 || binds->extents()[0] < joints->items().size())
      file.fail(skin, "the skin has fewer inverse bind matrices than joints",
                "export the file again");
  }
  std::vector<Matrix> matrices;
  for (size_t i = 0; i < joints->items().size(); ++i) {
    const JsonValue& item = joints->items()[i];
    const auto index = item.number();
    if (!index || !(*index >= 0 && *index < double(worlds.size())))
      file.fail(item, "this joint is no node", "export the file again");
    const Transform* world = worlds[size_t(*index)];
    matrices.push_back(
        joint_matrix(world ? *world : Transform(), binds ? floats_in(*binds).subspan(16 * i, 16)
                                                         : std::span<const float>(identity)));
  }
  return matrices;
}

/// The attributes name_0, name_1, … that a primitive has, each [count, 4].
std::vector<std::shared_ptr<const Array>> sets_of(File& file, Accessors& accessors,
                                                  const JsonValue& attributes,
                                                  std::string_view name, size_t count) {
  constexpr int most_sets = 8;
  std::vector<std::shared_ptr<const Array>> sets;
  for (int i = 0; i < most_sets; ++i) {
    const auto index = file.count(attributes, fmt::format("{}_{}", name, i));
    if (!index) break;
    sets.push_back(accessors.floats(*index, attributes));
    if (sets.back()->extents() != std::vector<size_t>{count, 4})
      file.fail(attributes, fmt::format("{}_{} does not go with the vertices", name, i),
                "export the file again");
  }
  return sets;
}

void add_targets(File& file, Accessors& accessors, const JsonValue& primitive,
                 const char* attribute, const std::vector<double>& weights,
                 std::vector<float>& values) {
  const JsonValue* targets = primitive.find("targets");
  if (!targets) return;
  const size_t count = std::min(weights.size(), targets->items().size());
  for (size_t i = 0; i < count; ++i) {
    const JsonValue& target = targets->items()[i];
    const auto index = file.count(target, attribute);
    if (!index || weights[i] == 0) continue;
    file.spend(values.size() * sizeof(float), target);  // time, for targets may share their numbers
    const auto offsets = accessors.floats(*index, target);
    if (offsets->count() != values.size())
      file.fail(target, "the morph target does not go with the vertices", "export the file again");
    const std::span<const float> numbers = floats_in(*offsets);
    for (size_t k = 0; k < values.size(); ++k) values[k] += float(weights[i]) * numbers[k];
  }
}

Vec3f moved(const Matrix& m, const Vec3f& v, float is_point) {
  return {m[0] * v.x + m[1] * v.y + m[2] * v.z + is_point * m[3],
          m[4] * v.x + m[5] * v.y + m[6] * v.z + is_point * m[7],
          m[8] * v.x + m[9] * v.y + m[10] * v.z + is_point * m[11]};
}

void skin(File& file, Accessors& accessors, const JsonValue& primitive, bool is_point,
          const std::vector<Matrix>& joints, std::vector<float>& values) {
  const JsonValue* attributes = primitive.find("attributes");
  const size_t count = values.size() / 3;
  const auto joint_sets = sets_of(file, accessors, *attributes, "JOINTS", count);
  const auto weight_sets = sets_of(file, accessors, *attributes, "WEIGHTS", count);
  const size_t sets = std::min(joint_sets.size(), weight_sets.size());
  for (size_t vertex = 0; vertex < count; ++vertex) {
    float* const at = &values[3 * vertex];
    const Vec3f before(at[0], at[1], at[2]);
    Vec3f after(0, 0, 0);
    float total = 0;
    for (size_t set = 0; set < sets; ++set)
      for (size_t i = 4 * vertex; i < 4 * vertex + 4; ++i) {
        const float weight = floats_in(*weight_sets[set])[i];
        const float joint = floats_in(*joint_sets[set])[i];
        if (!(weight > 0)) continue;
        if (!(joint >= 0 && joint < float(joints.size())))
          file.fail(*attributes, fmt::format("vertex {} has a joint that is not there", vertex),
                    "export the file again");
        after += moved(joints[size_t(joint)], before, is_point ? 1.0f : 0.0f) * weight;
        total += weight;
      }
    if (!(total > 0)) continue;
    if (is_point) after *= 1 / total;
    for (int k = 0; k < 3; ++k) at[k] = after[k];
  }
}

}  // namespace

Deformation deformation_of(File& file, Accessors& accessors, const PlacedNode& placed_node,
                           const JsonValue& mesh, const Pose& pose, const NodeWorlds& worlds) {
  const JsonValue& node = *placed_node.node;
  Deformation deformation;
  if (const std::vector<double>* moved = pose.find(placed_node.index, Animated::weights))
    deformation.weights = *moved;
  else
    deformation.weights = weights_of(file, node.find("weights") ? node : mesh);
  if (std::all_of(deformation.weights.begin(), deformation.weights.end(),
                  [](double weight) { return weight == 0; }))
    deformation.weights.clear();
  if (const JsonValue* skin = file.referred(node, "skin", "skins"))
    deformation.joints = joints_of(file, accessors, *skin, worlds);
  return deformation;
}

std::shared_ptr<const Array> deformed(File& file, Accessors& accessors, const JsonValue& primitive,
                                      const char* attribute, std::shared_ptr<const Array> values,
                                      const Deformation& deformation) {
  if (deformation.is_nothing()) return values;
  file.spend(values->bytes().size(), primitive);
  const std::span<const float> numbers = floats_in(*values);
  std::vector<float> result(numbers.begin(), numbers.end());
  add_targets(file, accessors, primitive, attribute, deformation.weights, result);
  if (!deformation.joints.empty())
    skin(file, accessors, primitive, std::string_view(attribute) == "POSITION", deformation.joints,
         result);
  return Array::of<float>(values->extents(), std::move(result));
}

}  // namespace kaustik::gltf
