#include "file_names.h"

#include <cctype>
#include <filesystem>

namespace kaustik::app {

std::string extension_of(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
  return extension.empty() ? extension : extension.substr(1);
}

}  // namespace kaustik::app
