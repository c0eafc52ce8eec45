#include "kaustik/loader/mitsuba_references.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <unordered_map>

#include "kaustik/loader/mitsuba_values.h"

namespace kaustik::mitsuba {

/// Looks for circles and for nesting that is too deep among objects and the references that are
/// still to be put in place.
class References::DepthCheck {
 public:
  DepthCheck(const std::vector<Reference>& references, Problems& problems) : problems_(problems) {
    for (const Reference& reference : references)
      if (reference.target) references_of_[reference.parent.get()].push_back(&reference);
  }

  /// Levels below and including `object`, or `failed`. `place` is that of the last reference on the
  /// way to it, which is what to change if it is too deep.
  int height(const Object* object, const Place& place) {
    heights_[object] = in_progress;
    path_.push_back(object);
    int result = 0;
    for (const Child& child : object->children)
      if (child.object) result = std::max(result, height_of(child.object.get(), place));
    if (const auto found = references_of_.find(object); found != references_of_.end())
      for (const Reference* reference : found->second)
        result = std::max(result, height_of(reference->target.get(), reference->place));
    path_.pop_back();
    return heights_[object] = std::min(result + 1, failed);
  }

 private:
  static constexpr int in_progress = -1;
  static constexpr int failed = maximum_depth + 1;

  /// The height of a part of the object at the end of the path.
  int height_of(const Object* part, const Place& place) {
    const auto known = heights_.find(part);
    if (known != heights_.end() && known->second == in_progress) {
      report(fmt::format("circular reference: {}", circle_to(part)),
             "no object can be a part of itself: remove one of these references", place);
      return failed;
    }
    int result = failed;
    if (known != heights_.end())
      result = known->second;
    else if (int(path_.size()) < maximum_depth)
      result = height(part, place);
    if (result + int(path_.size()) > maximum_depth)
      report(fmt::format("objects nest more than {} levels deep", maximum_depth),
             "make the scene flatter", place);
    return result;
  }

  /// Only the first: the others are mostly its consequences.
  void report(const std::string& message, const std::string& remedy, const Place& place) {
    if (!reported_) problems_.add(message, remedy, place);
    reported_ = true;
  }

  std::string circle_to(const Object* target) const {
    std::string text;
    for (auto at = std::find(path_.begin(), path_.end(), target); at != path_.end(); ++at)
      text += name_of(**at) + " → ";
    return text + name_of(*target);
  }

  static std::string name_of(const Object& object) {
    return object.id.empty() ? fmt::format("<{}>", object.family) : in_quotes(object.id);
  }

  Problems& problems_;
  std::unordered_map<const Object*, std::vector<const Reference*>> references_of_;
  std::unordered_map<const Object*, int> heights_;
  std::vector<const Object*> path_;
  bool reported_ = false;
};

void References::insert(const std::string& id, Declaration declaration, Problems& problems) {
  const auto [first, is_new] = declarations_.try_emplace(id, declaration);
  if (is_new) return;
  const Place& other = first->second.place;
  problems.add(fmt::format("the id {} is taken", in_quotes(id)),
               fmt::format("rename one of the two; the first is at {}:{}:{}", *other.file,
                           other.line, other.column),
               declaration.place);
}

void References::declare(const std::string& id, const std::shared_ptr<Object>& object,
                         const Place& place, Problems& problems) {
  insert(id, {object, {}, place}, problems);
}

void References::declare_alias(const std::string& id, const std::string& alias, const Place& place,
                               Problems& problems) {
  insert(alias, {nullptr, id, place}, problems);
}

void References::refer(const std::shared_ptr<Object>& parent, const std::string& child_name,
                       const std::string& id, const Place& place) {
  references_.push_back({parent, parent->children.size(), id, place, nullptr});
  parent->children.push_back({child_name, nullptr});
}

void References::leave_out(const std::string& id) { left_out_.insert(id); }

void References::follow(Declarations::iterator alias, Problems& problems) {
  std::vector<Declarations::iterator> chain;
  auto at = alias;
  while (at != declarations_.end() && !at->second.object && !at->second.followed) {
    at->second.followed = true;
    chain.push_back(at);
    at = declarations_.find(at->second.alias_of);
  }
  if (at == declarations_.end() && left_out_.contains(chain.back()->second.alias_of))
    for (const auto& on_the_way : chain) left_out_.insert(on_the_way->first);
  else if (at == declarations_.end())
    report_unknown(chain.back()->second.alias_of, chain.back()->second.place, problems);
  else if (at->second.object)
    for (const auto& on_the_way : chain) on_the_way->second.object = at->second.object;
  else if (std::find(chain.begin(), chain.end(), at) != chain.end())  // else told already
    problems.add(fmt::format("the alias {} stands for itself{}", in_quotes(at->first),
                             at->second.alias_of == at->first
                                 ? ""
                                 : fmt::format(", by way of {}", in_quotes(at->second.alias_of))),
                 "one of these aliases must name an object", at->second.place);
}

void References::report_unknown(const std::string& id, const Place& place, Problems& problems) {
  if (known_ids_.empty())
    for (const auto& [known, declaration] : declarations_)
      if (declaration.object) known_ids_.push_back(known);
  problems.add(fmt::format("no object has the id {}", in_quotes(id)),
               known_ids_.empty() ? "no object of the scene has an id" : suggestion(id, known_ids_),
               place);
}

void References::resolve(const std::shared_ptr<Object>& scene, Problems& problems) {
  for (auto at = declarations_.begin(); at != declarations_.end(); ++at)
    if (!at->second.object && !at->second.followed) follow(at, problems);
  for (Reference& reference : references_) {
    const auto found = declarations_.find(reference.id);
    if (left_out_.contains(reference.id) && (found == declarations_.end() || !found->second.object))
      continue;
    if (found == declarations_.end())
      report_unknown(reference.id, reference.place, problems);
    else
      reference.target = found->second.object;  // null: an alias that has been told already
  }
  if (!problems.empty()) return;
  DepthCheck(references_, problems).height(scene.get(), scene->place);
  if (!problems.empty()) return;
  for (const Reference& reference : references_)
    reference.parent->children[reference.child_index].object = reference.target;
  std::set<Object*> with_gaps;
  for (const Reference& reference : references_)
    if (!reference.target) with_gaps.insert(reference.parent.get());
  for (Object* parent : with_gaps)
    std::erase_if(parent->children, [](const Child& child) { return !child.object; });
}

}  // namespace kaustik::mitsuba
