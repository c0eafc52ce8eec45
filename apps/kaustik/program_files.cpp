#include "program_files.h"

#include <initializer_list>
#include <system_error>

namespace kaustik::app {
namespace {

namespace fs = std::filesystem;

/// How many folders above the program are searched: build/release/kaustik lies three below.
constexpr int most_floors = 3;

/// `inside`, which has to hold `mark`, of the folder that the program lies in or of one above it.
fs::path found_above(std::initializer_list<const char*> inside, const char* mark) {
  std::error_code none;
  fs::path floor = fs::read_symlink("/proc/self/exe", none).parent_path();
  for (int i = 0; i < most_floors && floor.has_relative_path(); ++i, floor = floor.parent_path())
    for (const char* const folder : inside)
      if (fs::exists(floor / folder / mark, none)) return floor / folder;
  return {};
}

}  // namespace

fs::path scenes_folder() {
  // Folders of other programs have such names, too.
  return found_above({"share/kaustik/scenes", "scenes"}, "examples/caustic.xml");
}

std::string scene_file(const std::string& path) {
  std::error_code none;
  if (!path.starts_with("scenes/") || fs::exists(path, none)) return path;
  const fs::path folder = scenes_folder();
  if (folder.empty()) return path;
  const fs::path shipped = folder.parent_path() / path;
  return fs::is_regular_file(shipped, none) ? shipped.string() : path;
}

fs::path manual_page() {
  const fs::path scenes = scenes_folder();
  if (scenes.empty()) return {};
  const fs::path root = scenes.parent_path();
  std::error_code none;
  for (const fs::path& page :
       {root / "../doc/kaustik/docs/index.md", root / "../doc/kaustik/README.md",
        root / "docs/index.md", root / "README.md"})
    if (fs::exists(page, none)) return page.lexically_normal();
  return {};
}

std::string shown_path(const fs::path& path) {
  std::error_code none;
  const fs::path relative = fs::proximate(path, none);
  const bool is_below = !none && !relative.empty() && *relative.begin() != "..";
  return (is_below ? relative : path).string();
}

}  // namespace kaustik::app
