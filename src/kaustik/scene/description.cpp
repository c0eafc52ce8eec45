#include "kaustik/scene/description.h"

#include <map>

namespace kaustik {
namespace {

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

Description copy_of(const Description& description) {
  Copies copies;
  Description copy = description;
  copy.scene = copied(description.scene, copies);
  return copy;
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
