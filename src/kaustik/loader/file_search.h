#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "kaustik/base/place.h"

namespace kaustik {

/// For what a file names that belongs to the scene: the file of that name in the folder, or one
/// that stands for it, which is told with the place. Nothing if there is none.
using FindBeside = std::function<std::optional<std::filesystem::path>(
    const std::string& name, const std::filesystem::path& folder, const Place& place)>;

/// Looks for files that are not where a scene says, as scenes are moved from one computer to
/// another. Looks only into folders that it is given and those that the name leads to from there,
/// and reads none of their files. Folders are listed once, and only their first entries; after many
/// searches it finds nothing any more.
class FileSearch {
 public:
  /// The first that there is of, in each of the folders in order: the name without the blanks
  /// around it; the last parts of the name, the longest first, if it is an absolute path, of
  /// Windows or not; the same names without regard to case; and, if it is the name of a picture, a
  /// picture of another format that Kaustik reads. Nothing if there is none.
  std::optional<std::filesystem::path> find_like(const std::string& name,
                                                 const std::vector<std::filesystem::path>& folders);

 private:
  /// What a folder holds: files and folders.
  struct Listing {
    std::set<std::string> names;
    std::map<std::string, std::string> by_small_letters;  ///< the first of those that are alike
  };

  const Listing& listing_of(const std::filesystem::path& folder);
  /// The path in the folder, each part as it is written or else without regard to case.
  std::optional<std::filesystem::path> find_in_any_case(const std::filesystem::path& folder,
                                                        const std::filesystem::path& relative);
  std::optional<std::filesystem::path> find_other_picture(const std::filesystem::path& folder,
                                                          const std::filesystem::path& relative);

  std::map<std::filesystem::path, Listing> listed_;
  size_t searches_ = 0;
};

}  // namespace kaustik
