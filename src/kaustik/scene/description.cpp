#include "kaustik/scene/description.h"

namespace kaustik {
namespace {

void collect_files(const Object& object, std::set<const Object*>& seen,
                   std::set<std::string>& files) {
  if (!seen.insert(&object).second) return;
  for (const Property& property : object.properties)
    if (const std::string file = file_of(property); !file.empty()) files.insert(file);
  for (const Child& child : object.children) collect_files(*child.object, seen, files);
}

}  // namespace

std::string file_of(const Property& property) {
  if (property.name != "filename" && property.name != "photon_map") return {};
  if (const auto* text = std::get_if<std::string>(&property.value)) return *text;
  if (const auto* untyped = std::get_if<Untyped>(&property.value)) return untyped->text;
  return {};
}

std::set<std::string> named_files(const Description& description) {
  std::set<const Object*> seen;
  std::set<std::string> files;
  collect_files(*description.scene, seen, files);
  return files;
}

}  // namespace kaustik
