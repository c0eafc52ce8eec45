#include "kaustik/scene/merged_shapes.h"

#include <fmt/format.h>

#include <map>

namespace kaustik {
namespace {

bool is_merge(const Object& object) { return object.family == "shape" && object.type == "merge"; }

/// Takes merges apart; objects that several others share stay shared.
class Separator {
 public:
  std::shared_ptr<Object> separated(const std::shared_ptr<Object>& object) {
    // What holds itself is found here while it is gone through, and left to those who refuse it.
    const auto [known, is_new] = done_.try_emplace(object.get(), object);
    if (!is_new) return known->second;
    std::vector<Child> children;
    bool is_changed = false;
    for (const Child& child : object->children) {
      if (is_merge(*child.object)) {
        add_shapes(*child.object, 0, children);
        is_changed = true;
        continue;
      }
      children.push_back({child.name, separated(child.object)});
      is_changed |= children.back().object != child.object;
    }
    std::shared_ptr<Object> result = object;
    if (is_changed) {
      result = std::make_shared<Object>(*object);
      result->children = std::move(children);
    }
    return done_[object.get()] = result;
  }

 private:
  void add_shapes(const Object& merge, int level, std::vector<Child>& children) {
    if (level > most_levels)
      throw Error(ErrorKind::input,
                  fmt::format("shapes 'merge' nest more than {} levels deep", most_levels),
                  "make the scene flatter", merge.place);
    for (const Child& child : merge.children) {
      if (child.object->family != "shape")
        throw Error(ErrorKind::input,
                    fmt::format("shape 'merge' cannot hold a {}", child.object->family),
                    "put it into the shapes that are merged", child.object->place);
      if (++merged_ > most_merged)
        throw Error(ErrorKind::input,
                    fmt::format("shapes 'merge' hold more than {} shapes in all", most_merged),
                    "refer to fewer of them, or place them as instances", merge.place);
      if (is_merge(*child.object))
        add_shapes(*child.object, level + 1, children);
      else
        children.push_back({child.name, separated(child.object)});
    }
  }

  static constexpr int most_levels = 100;
  static constexpr size_t most_merged = 1'000'000;  ///< merges may refer to one another
  size_t merged_ = 0;
  std::map<const Object*, std::shared_ptr<Object>> done_;
};

}  // namespace

std::shared_ptr<Object> without_merges(const std::shared_ptr<Object>& scene) {
  return Separator().separated(scene);
}

}  // namespace kaustik
