#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace kaustik {

/// Looks for files that are not where a scene says, as scenes are moved from one computer to
/// another. Looks only into folders that it is given and those that the name leads to from there,
/// and reads none of their files. Folders are listed once, and only their first entries.
class FileSearch {
 public:
  /// The first that there is of, in each of the folders in order: the name without the blanks
  /// around it; the bare name, if the name is an absolute path, of Windows or not; the same names
  /// without regard to case; and, if it is the name of a picture, a picture of another format that
  /// Kaustik reads. Nothing if there is none.
  std::optional<std::filesystem::path> find_like(const std::string& name,
                                                 const std::vector<std::filesystem::path>& folders);

 private:
  using Names = std::vector<std::string>;  ///< of files and folders, in order

  const Names& names_in(const std::filesystem::path& folder);
  /// The path in the folder, each part as it is written or else without regard to case.
  std::optional<std::filesystem::path> find_in_any_case(const std::filesystem::path& folder,
                                                        const std::filesystem::path& relative);
  std::optional<std::filesystem::path> find_other_picture(const std::filesystem::path& folder,
                                                          const std::filesystem::path& relative);

  std::map<std::filesystem::path, Names> listed_;
};

}  // namespace kaustik
