#pragma once
// Small steps in making objects of a description.

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "kaustik/loader/deviations.h"
#include "kaustik/scene/description.h"

namespace kaustik::pbrt {

inline std::shared_ptr<Object> described(const char* family, const char* type, const Place& place) {
  return std::make_shared<Object>(Object{family, type, "", {}, {}, place});
}

/// Of definitions of one name, by their order: the last one before its user, or else the first one.
/// `sequence_of`: of an index, how many things were defined before it.
template <typename SequenceOf>
size_t definition_before(const std::vector<size_t>& indices, size_t user,
                         const SequenceOf& sequence_of) {
  const auto after = std::partition_point(indices.begin(), indices.end(),
                                          [&](size_t i) { return sequence_of(i) < user; });
  return after == indices.begin() ? indices.front() : *(after - 1);
}

/// The ids of a scene: what pbrt names alike in its several name spaces is told apart by a number.
class Ids {
 public:
  std::string unused(const std::string& name) {
    int& uses = uses_[name];
    std::string id;
    do {
      ++uses;
      id = uses == 1 ? name : name + "_" + std::to_string(uses);
    } while (!taken_.insert(id).second);
    return id;
  }

 private:
  std::map<std::string, int> uses_;
  std::set<std::string> taken_;
};

inline void set(Object& object, const char* name, Value value) {
  object.properties.push_back({name, std::move(value), object.place});
}

inline void hold(Object& object, const char* name, std::shared_ptr<Object> child) {
  object.children.push_back({name, std::move(child)});
}

/// What a maker makes, for what is told about it.
struct Subject {
  Deviations& deviations;
  std::string object;  ///< "shape 'sphere'"
  Place where;         ///< of the directive

  const Place& place() const { return where; }
  void approximated(const std::string& what) const { deviations.approximated(object, what, where); }
};

/// A value, or a texture that stands for it; neither: nothing was given.
struct Input {
  std::optional<Value> value;
  std::shared_ptr<Object> texture;

  bool is_given() const { return value || texture; }
};

inline void set(Object& object, const char* name, const Input& input) {
  if (input.texture)
    hold(object, name, input.texture);
  else if (input.value)
    set(object, name, *input.value);
}

}  // namespace kaustik::pbrt
