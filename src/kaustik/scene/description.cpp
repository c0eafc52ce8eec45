#include "kaustik/scene/description.h"

#include <algorithm>
#include <cctype>
#include <map>

namespace kaustik {
namespace {

size_t length_without_number(const std::string& name) {
  size_t length = name.size();
  while (length > 0 && std::isdigit(static_cast<unsigned char>(name[length - 1]))) --length;
  return length;
}

/// "b2" before "b10".
bool comes_before(const std::string& a, const std::string& b) {
  const size_t text_a = length_without_number(a), text_b = length_without_number(b);
  const int order = a.substr(0, text_a).compare(b.substr(0, text_b));
  if (order != 0 || text_a == a.size() || text_b == b.size()) return a < b;
  // Of digits without zeros before them the longer ones are more.
  const std::string digits_a = a.substr(std::min(a.find_first_not_of('0', text_a), a.size()));
  const std::string digits_b = b.substr(std::min(b.find_first_not_of('0', text_b), b.size()));
  if (digits_a.size() != digits_b.size()) return digits_a.size() < digits_b.size();
  return digits_a < digits_b;
}

void collect_files(const Object& object, const TypeTables& types, std::set<const Object*>& seen,
                   std::set<std::string>& files) {
  if (!seen.insert(&object).second) return;
  const TypeInfo* info = types.find(object.family, object.type);
  for (const Property& property : object.properties)
    if (const std::string file = file_of(property, info); !file.empty()) files.insert(file);
  for (const Child& child : object.children) collect_files(*child.object, types, seen, files);
}

using Copies = std::map<const Object*, std::shared_ptr<Object>>;

std::shared_ptr<Object> copied(const std::shared_ptr<Object>& object, Copies& copies) {
  if (!object) return nullptr;
  std::shared_ptr<Object>& copy = copies[object.get()];
  if (copy) return copy;
  copy = std::make_shared<Object>(*object);
  const std::shared_ptr<Object> result = copy;
  for (Child& child : result->children) child.object = copied(child.object, copies);
  return result;
}

}  // namespace

std::string_view name_of(DeviationKind kind) {
  switch (kind) {
    case DeviationKind::approximated:
      return "approximated";
    case DeviationKind::ignored:
      return "ignored";
    case DeviationKind::missing:
      return "missing";
  }
  return "";
}

Description copy_of(const Description& description) {
  Copies copies;
  Description copy = description;
  copy.scene = copied(description.scene, copies);
  return copy;
}

std::vector<const Child*> ordered_children(const Object& object, const std::string& family) {
  std::vector<const Child*> children;
  for (const Child& child : object.children)
    if (child.object->family == family) children.push_back(&child);
  std::stable_sort(children.begin(), children.end(),
                   [](const Child* a, const Child* b) { return comes_before(a->name, b->name); });
  return children;
}

std::string file_of(const Property& property, const TypeInfo* info) {
  const Parameter* row = info ? info->find(property.name) : nullptr;
  if (!row || row->kind != ParameterKind::file) return {};
  if (const auto* text = std::get_if<std::string>(&property.value)) return *text;
  if (const auto* untyped = std::get_if<Untyped>(&property.value)) return untyped->text;
  return {};
}

std::set<std::string> named_files(const Description& description, const TypeTables& types) {
  std::set<const Object*> seen;
  std::set<std::string> files;
  collect_files(*description.scene, types, seen, files);
  return files;
}

}  // namespace kaustik
