#include "kaustik/loader/pbrt/texture_mixes.h"

#include <algorithm>
#include <map>
#include <set>

#include "kaustik/loader/object_parts.h"

namespace kaustik::pbrt {
namespace {

/// Mixtures in one bsdf: each doubles it.
constexpr int most_mixes = 5;

const Object* first_mix(const Object& object, std::set<const Object*>& seen) {
  if (!seen.insert(&object).second) return nullptr;
  if (object.family == "texture" && object.type == "mix") return &object;
  for (const Child& child : object.children)
    if (const Object* mix = first_mix(*child.object, seen)) return mix;
  return nullptr;
}

const Child* child_named(const Object& object, std::string_view name) {
  for (const Child& child : object.children)
    if (child.name == name) return &child;
  return nullptr;
}

/// Copies objects, with one of the two textures of a mix in its place; null: of all mixes.
class MixReplacer {
 public:
  MixReplacer(const Object* mix, const char* kept) : mix_(mix), kept_(kept) {}

  std::shared_ptr<Object> copy(const std::shared_ptr<Object>& object) {
    std::shared_ptr<Object>& copied = copies_[object.get()];
    if (copied) return copied;
    const auto made = std::make_shared<Object>(*object);
    made->id.clear();
    made->children.clear();
    for (const Child& child : object->children) add(*made, child);
    return copies_[object.get()] = made;
  }

 private:
  bool is_replaced(const Object& object) const {
    return mix_ ? &object == mix_ : object.family == "texture" && object.type == "mix";
  }
  /// Mixes lie in one another as deep as textures do.
  void add(Object& parent, const Child& child) {
    if (!is_replaced(*child.object)) {
      parent.children.push_back({child.name, copy(child.object)});
    } else if (const Child* texture = child_named(*child.object, kept_)) {
      add(parent, {child.name, texture->object});
    } else if (const Property* value = find_property(*child.object, kept_)) {
      parent.properties.push_back({child.name, value->value, child.object->place});
    }
  }

  const Object* mix_;
  const char* kept_;
  std::map<const Object*, std::shared_ptr<Object>> copies_;
};

std::shared_ptr<Object> split(const std::shared_ptr<Object>& bsdf, int level, bool& is_too_deep) {
  std::set<const Object*> seen;
  const Object* mix = first_mix(*bsdf, seen);
  if (!mix) return bsdf;
  if (level >= most_mixes) {
    is_too_deep = true;
    return MixReplacer(nullptr, "color0").copy(bsdf);
  }
  const auto part = [&](const char* kept) {
    return split(MixReplacer(mix, kept).copy(bsdf), level + 1, is_too_deep);
  };
  auto blend = described("bsdf", "blendbsdf", mix->place);
  if (const Child* weight = child_named(*mix, "weight"))
    hold(*blend, "weight", weight->object);
  else if (const Property* weight_value = find_property(*mix, "weight"))
    set(*blend, "weight", weight_value->value);
  hold(*blend, "", part("color0"));
  hold(*blend, "", part("color1"));
  return split(blend, level + 1, is_too_deep);
}

}  // namespace

Input mixed(const Input& first, const Input& second, const Input& amount, const Place& place) {
  const auto a = first.value ? as_colour(*first.value) : std::nullopt;
  const auto b = second.value ? as_colour(*second.value) : std::nullopt;
  const auto share = amount.value ? as_number(*amount.value) : std::nullopt;
  if (share && *share <= 0) return first;
  if (share && *share >= 1) return second;
  if (a && b && share) {
    const auto between = [&](double x, double y) { return x + (y - x) * *share; };
    if (as_number(*first.value) && as_number(*second.value)) return {between(a->r, b->r), nullptr};
    return {Value(Rgb{between(a->r, b->r), between(a->g, b->g), between(a->b, b->b)}), nullptr};
  }
  auto mix = described("texture", "mix", place);
  set(*mix, "color0", first);
  set(*mix, "color1", second);
  set(*mix, "weight", amount);
  return {{}, mix};
}

std::shared_ptr<Object> without_mixes(std::shared_ptr<Object> bsdf, const std::string& object,
                                      Deviations& deviations) {
  bool is_too_deep = false;
  const Place place = bsdf->place;
  bsdf = split(bsdf, 0, is_too_deep);
  if (is_too_deep)
    deviations.approximated(object, "of its many mixed textures some are the first of the two",
                            place);
  return bsdf;
}

}  // namespace kaustik::pbrt
