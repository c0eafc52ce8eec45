#pragma once
// What surfaces are made of: chains of mixtures, patterns, textures and a material.

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "kaustik/base/transform.h"
#include "kaustik/loader/radiance/statements.h"

namespace kaustik::radiance {

struct Modifier;
using ModifierPointer = std::shared_ptr<const Modifier>;  ///< null: void

/// A modifier where it is defined.
struct Modifier {
  std::shared_ptr<const Primitive> primitive;
  Transform placed;                              ///< world from the space of its file
  ModifierPointer below;                         ///< what modifies it
  std::map<std::string, ModifierPointer> named;  ///< those that its strings name
  int depth = 0, mixtures = 0;                   ///< of what it stands on, at most

  const std::string& type() const { return primitive->type; }
  const std::vector<std::string>& strings() const { return primitive->strings; }
  const std::vector<double>& reals() const { return primitive->reals; }
  const Place& place() const { return primitive->place; }
};

/// The modifiers by their names, each as it was defined last.
class Modifiers {
 public:
  static constexpr int deepest = 200, deepest_mixture = 6;

  /// Of a modifier, a surface or an alias. Throws Error(input) where nothing has that name.
  ModifierPointer find(const std::string& name, const Place& place) const;
  /// Whether nothing has that name, nor one that is like it but for those that stand in.
  bool is_unheard_of(const std::string& name) const;
  /// Defines what stands in for a modifier that is not there.
  void define_stand_in(const std::shared_ptr<const Primitive>& primitive);
  /// Defines a modifier or an alias. One that is there already, from the same place in a file and
  /// under what is the same, stays: so copies of objects share their materials. Throws Error(input)
  /// for names of nothing, and chains that are too long.
  void define(std::shared_ptr<const Primitive> primitive, const Transform& placed);

 private:
  /// "did you mean …?" of a name that is defined; "": none is near.
  std::string suggestion_for(const std::string& name) const;

  std::map<std::string, ModifierPointer> known_;
  std::set<std::string> stand_ins_;
  std::vector<ModifierPointer> all_;  ///< kept, for others know them by their addresses
};

/// What a surface looks like: a chain of modifiers taken apart. Patterns and textures are those
/// from the surface on, then those behind the material.
struct Look {
  const Modifier* material = nullptr;  ///< null: void, or a mixture
  const Modifier* mixture = nullptr;   ///< what mixes two others
  std::vector<const Modifier*> patterns, textures;
};
Look look_of(const Modifier* modifier);

}  // namespace kaustik::radiance
