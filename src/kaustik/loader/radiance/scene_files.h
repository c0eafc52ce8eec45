#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "kaustik/loader/deviations.h"
#include "kaustik/loader/file_search.h"
#include "kaustik/loader/radiance/budget.h"
#include "kaustik/loader/radiance/statements.h"

namespace kaustik::radiance {

/// The files of a scene: found beside the file that names them, in the folder of the scene, and in
/// the working folder, since Radiance looks there alone.
class SceneFiles {
 public:
  SceneFiles(std::filesystem::path scene_folder, bool is_strict, Deviations& deviations)
      : scene_folder_(std::move(scene_folder)), is_strict_(is_strict), deviations_(deviations) {}

  /// Unless strict also one of a name that is alike, which is told. Nothing if there is none.
  std::optional<std::filesystem::path> find(const std::string& name,
                                            const std::filesystem::path& own_folder,
                                            const Place& place);
  /// The same of a part of the scene; that there is none is told as missing.
  std::optional<std::filesystem::path> find_part(const std::string& name,
                                                 const std::filesystem::path& own_folder,
                                                 const Place& place);
  /// The same of what cannot be left out; throws Error(input) if there is none.
  std::filesystem::path found(const std::string& name, const std::filesystem::path& own_folder,
                              const Place& place);
  /// Of a file that `place` names, unpacked; counts as a source. Throws Error(input).
  std::string text_of(const std::filesystem::path& path, const Place& place);
  /// Messages may quote it whatever it holds: the user names it.
  void trust(const std::filesystem::path& path) { trusted_ = path; }
  /// Of a scene file, parsed once.
  std::shared_ptr<const Statements> statements_of(const std::filesystem::path& path,
                                                  const Place& place);

  const std::filesystem::path& scene_folder() const { return scene_folder_; }
  const std::set<std::string>& sources() const { return sources_; }
  PlacingBudget& budget() { return budget_; }

 private:
  std::filesystem::path scene_folder_;
  bool is_strict_;
  Deviations& deviations_;
  FileSearch search_;
  std::filesystem::path trusted_;
  PlacingBudget budget_;
  std::set<std::string> sources_;
  std::map<std::string, std::shared_ptr<const Statements>> parsed_;
  size_t read_bytes_ = 0, read_files_ = 0;
};

}  // namespace kaustik::radiance
