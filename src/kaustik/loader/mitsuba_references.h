#pragma once
#include <map>
#include <memory>
#include <set>
#include <string>

#include <vector>

#include "kaustik/base/error.h"
#include "kaustik/scene/description.h"

namespace kaustik::mitsuba {

/// Elements within elements, also by reference: what walks the description may recurse this deep.
inline constexpr int maximum_depth = 100;

/// The ids of a scene and who refers to them. Objects are found when everything has been read, so a
/// reference may stand before what it refers to.
class References {
 public:
  void declare(const std::string& id, const std::shared_ptr<Object>& object, const Place& place,
               Problems& problems);
  void declare_alias(const std::string& id, const std::string& alias, const Place& place,
                     Problems& problems);
  /// Of something that is left out of the scene: who refers to it does without it.
  void leave_out(const std::string& id);
  /// Adds a child to `parent` that holds nothing until resolve().
  void refer(const std::shared_ptr<Object>& parent, const std::string& child_name,
             const std::string& id, const Place& place);
  /// Puts the objects in their places, unless there is a problem: unknown id, circle, too deep.
  void resolve(const std::shared_ptr<Object>& scene, Problems& problems);

 private:
  struct Declaration {
    std::shared_ptr<Object> object;  ///< null for an alias, until resolve() has found it
    std::string alias_of;
    Place place;
    bool followed = false;  ///< an alias that resolve() has been at
  };
  struct Reference {
    std::shared_ptr<Object> parent;
    size_t child_index;
    std::string id;
    Place place;
    std::shared_ptr<Object> target;
  };
  class DepthCheck;

  using Declarations = std::map<std::string, Declaration>;

  void insert(const std::string& id, Declaration declaration, Problems& problems);
  /// Finds what an alias stands for, and all those on the way there.
  void follow(Declarations::iterator alias, Problems& problems);
  void report_unknown(const std::string& id, const Place& place, Problems& problems);

  Declarations declarations_;
  std::set<std::string> left_out_;  ///< ids
  std::vector<Reference> references_;
  std::vector<std::string> known_ids_;  ///< that lead to an object; for messages
};

}  // namespace kaustik::mitsuba
