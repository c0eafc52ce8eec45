#include "shipped_scenes.h"

#include <filesystem>
#include <system_error>

#include "build_facts.h"

namespace kaustik::app {
namespace {

namespace fs = std::filesystem;

/// Where the installation has its scenes; empty if the system does not tell where the program is.
fs::path installed_data() {
  std::error_code error;
  const fs::path program = fs::canonical("/proc/self/exe", error);
  return error ? fs::path() : (program.parent_path() / KAUSTIK_DATA_FOLDER).lexically_normal();
}

}  // namespace

std::string scene_file(const std::string& path) {
  std::error_code error;
  if (!path.starts_with("scenes/") || fs::exists(path, error)) return path;
  const fs::path data = installed_data();
  return !data.empty() && fs::is_regular_file(data / path, error) ? (data / path).string() : path;
}

}  // namespace kaustik::app
