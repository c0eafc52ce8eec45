#include "kaustik/loader/nori/reading.h"

#include <fmt/format.h>

#include "kaustik/base/error.h"
#include "kaustik/loader/obj_scan.h"

namespace kaustik::nori {

namespace fs = std::filesystem;

std::optional<std::string> Reading::path_of(const std::string& name, const Place& place,
                                            const std::string& instead) {
  const fs::path path = folder_ / name;
  std::error_code ignored;
  if (fs::exists(path, ignored)) return path.string();
  const auto like = is_strict_ ? std::nullopt : search_.find_like(name, {folder_});
  if (!like) {
    deviations.missing(fmt::format("file '{}'", name), "it is not there: " + instead, place);
    return std::nullopt;
  }
  deviations.approximated(
      "file " + like->filename().string(),
      fmt::format("there is no file of the name given: '{}' stands for it", like->string()), place);
  return like->string();
}

void Reading::ignore_parts(const Object& element, const std::set<const Object*>& taken) {
  for (const Child& child : element.children)
    if (!taken.contains(child.object.get()))
      ignored(*child.object, fmt::format("there is no such part of a {} here", element.family));
}

bool Reading::has_normals(const std::string& path) {
  const auto known = has_normals_.find(path);
  if (known != has_normals_.end()) return known->second;
  bool has_any = true;
  std::error_code ignored;
  if (fs::is_regular_file(path, ignored)) try {
      has_any = scan_obj(path).has_normals;
    } catch (const Error&) {
      // Who reads the mesh tells what is wrong with it.
    }
  return has_normals_[path] = has_any;
}

}  // namespace kaustik::nori
