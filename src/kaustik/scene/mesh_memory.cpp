#include "kaustik/scene/mesh_memory.h"

#include <filesystem>
#include <set>

namespace kaustik {
namespace {

/// Of memory for one of a file.
constexpr uint64_t bytes_per_byte = 7;

void collect_mesh_files(const Object& object, std::set<const Object*>& seen,
                        std::set<std::string>& files) {
  if (!seen.insert(&object).second) return;
  if (object.family == "shape")
    for (const Property& property : object.properties)
      if (const std::string file = file_of(property); !file.empty()) files.insert(file);
  for (const Child& child : object.children) collect_mesh_files(*child.object, seen, files);
}

}  // namespace

uint64_t expected_mesh_memory(const Description& description) {
  std::set<const Object*> seen;
  std::set<std::string> files;
  collect_mesh_files(*description.scene, seen, files);
  uint64_t bytes = 0;
  for (const std::string& file : files) {
    std::error_code unreadable;
    const auto size = std::filesystem::file_size(file, unreadable);
    if (!unreadable) bytes += size;
  }
  return bytes_per_byte * bytes;
}

}  // namespace kaustik
