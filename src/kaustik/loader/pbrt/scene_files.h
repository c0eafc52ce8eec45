#pragma once
// The files that a scene of pbrt consists of and names.

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "kaustik/loader/deviations.h"
#include "kaustik/loader/file_search.h"
#include "kaustik/loader/pbrt/tokenizer.h"

namespace kaustik::pbrt {

/// For remedies.
inline constexpr const char* where_files_lie =
    "names are relative to the folder of the main scene file";

/// Finds and reads files. Names are relative to the folder of the main file, as in pbrt, wherever
/// they are written. Keeps all texts until it ends, and counts what reading takes.
class SceneFiles {
 public:
  /// `deviations` must outlive this.
  SceneFiles(std::filesystem::path folder, bool is_strict, Deviations& deviations);

  /// The scene file itself.
  SourceText main_file(const std::string& path);
  /// The same as text, which must outlive this.
  SourceText main_text(std::string_view text, const std::string& name);

  /// Names of files that are being read, outermost first: one of them can't be included in itself.
  class Opened {
   public:
    /// Throws Error(input) if the file is not there or no scene, is open already, is too deep, or
    /// all is too much.
    Opened(SceneFiles& files, const std::string& name, const Place& place);
    ~Opened() { files_.open_.pop_back(); }
    Opened(const Opened&) = delete;
    Opened& operator=(const Opened&) = delete;
    const SourceText& source() const { return source_; }

   private:
    SceneFiles& files_;
    SourceText source_;
  };

  /// A file that the scene names; one of a similar name stands for it where it is not there, which
  /// is told. Nothing: there is none.
  std::optional<std::filesystem::path> find(const std::string& name, const Place& place);
  /// Its bytes, unpacked, at most so many; throws Error(input) at the place.
  std::vector<uint8_t> bytes_of(const std::filesystem::path& path, size_t most, const Place& place);

  /// Scene files and spectra that were read.
  const std::set<std::string>& sources() const { return sources_; }

  /// Memory that objects of the scene take beside what the text writes: meshes of spheres and
  /// curves, and what directives repeat. Throws Error(input) where it is out of proportion to the
  /// text.
  void spend(size_t bytes, const Place& place);

 private:
  SourceText included(const std::filesystem::path& path, const Place& place);
  SourceText keep(std::vector<uint8_t> bytes, const std::string& name);

  std::filesystem::path folder_;
  bool is_strict_;
  Deviations& deviations_;
  FileSearch search_;
  std::map<std::filesystem::path, SourceText> texts_;  ///< by their identity
  std::map<std::string, std::optional<std::filesystem::path>> found_;
  std::set<std::string> sources_;
  std::vector<std::filesystem::path> open_;
  size_t includes_ = 0, read_bytes_ = 0, repeated_bytes_ = 0, spent_bytes_ = 0;
};

/// Whether pbrt knows it as a directive.
bool is_directive(std::string_view word);
/// Whether a text begins as a file of pbrt: by a directive, behind comments.
bool begins_as_pbrt(std::string_view text);

}  // namespace kaustik::pbrt
