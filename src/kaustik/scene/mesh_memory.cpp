#include "kaustik/scene/mesh_memory.h"

#include <filesystem>
#include <set>

#include "kaustik/scene/type_tables.h"

namespace kaustik {
namespace {

/// Of memory for one of a file.
constexpr uint64_t bytes_per_byte = 7;

/// Where meshes come from.
struct Sources {
  std::set<std::string> files;
  std::set<const Array*> arrays;
};

void collect(const Object& object, std::set<const Object*>& seen, Sources& sources) {
  if (!seen.insert(&object).second) return;
  if (object.family == "shape") {
    const TypeInfo* info = scene_types().find(object.family, object.type);
    for (const Property& property : object.properties) {
      if (const std::string file = file_of(property, info); !file.empty())
        sources.files.insert(file);
      if (const auto* array = std::get_if<std::shared_ptr<const Array>>(&property.value))
        if (*array) sources.arrays.insert(array->get());
    }
  }
  for (const Child& child : object.children) collect(*child.object, seen, sources);
}

}  // namespace

uint64_t expected_mesh_memory(const Description& description) {
  std::set<const Object*> seen;
  Sources sources;
  collect(*description.scene, seen, sources);
  uint64_t bytes = 0;
  for (const Array* array : sources.arrays) bytes += array->bytes().size();
  for (const std::string& file : sources.files) {
    std::error_code unreadable;
    const auto size = std::filesystem::file_size(file, unreadable);
    if (!unreadable) bytes += size;
  }
  return bytes_per_byte * bytes;
}

}  // namespace kaustik
