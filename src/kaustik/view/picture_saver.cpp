#include "kaustik/view/picture_saver.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "kaustik/image/image_io.h"
#include "kaustik/view/request_error.h"

namespace kaustik::view {
namespace {

constexpr size_t longest_name = 100;

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
         c == '_' || c == '-' || c == ' ';
}

}  // namespace

std::string PictureSaver::path_for(const std::string& name) const {
  if (name.empty() || name.size() > longest_name || name.front() == '.' || name.front() == ' ' ||
      name.front() == '-' || !std::all_of(name.begin(), name.end(), is_plain))
    throw RequestError(400, "this is no plain file name",
                       "give letters, digits, '.', '_' and '-' only: picture.exr");
  check_extension(name);
  std::string path = (std::filesystem::path(folder_) / name).string();
  std::error_code error;
  // Of links themselves: where they lead nobody asked for.
  const auto there = std::filesystem::symlink_status(path, error).type();
  if (there != std::filesystem::file_type::not_found && !saved_.contains(name))
    throw RequestError(409, fmt::format("there is a file '{}' already", name),
                       "choose another name");
  return path;
}

void PictureSaver::save(const Image& image, const std::string& name) {
  write_image(image, path_for(name));
  saved_.insert(name);
}

}  // namespace kaustik::view
