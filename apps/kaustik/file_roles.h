#pragma once
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "kaustik/base/error.h"
#include "kaustik/scene/description.h"

namespace kaustik::app {

/// A kind of files that are no pictures.
struct FileKind {
  const char* name;  ///< "a checkpoint"
  bool (*is_one)(const std::string& path);
};

/// Of files that are somebody's work, whatever is in them: they are not replaced without --force.
extern const FileKind any_file;

/// What an output may replace.
enum class Replacing { nothing, own_kind, anything };

/// The files that a command reads and writes. To be checked before long work: nothing that it reads
/// may be replaced, and nothing may be written twice, under whatever names and links. Standard
/// input and output ("-") are no files.
class FileRoles {
 public:
  /// Throws Error(input) for standard input, from which only scenes are read. `may_be_replaced`: by
  /// --force, which was given or not.
  void reads(const std::string& path, std::optional<bool> may_be_replaced = {});
  /// A scene file, or standard input.
  void reads_scene(const std::string& path);
  /// The scene files and all that they name.
  void reads(const Description& description);
  /// A picture. Throws Error(input) if another output, or something that is read, is this file.
  void writes(const std::string& path);
  /// Something else. Throws Error(input) as writes() and check_output_path() do, for standard
  /// output, and for what is there and may not be replaced; `if_of_kind` is what to do about a file
  /// of that kind. Empty files may be replaced.
  void writes(const std::string& path, const FileKind& kind, Replacing replacing,
              const std::string& if_of_kind);
  /// The same of what may replace its own kind, and may be something else than a file, a pipe.
  void writes_stream(const std::string& path, const FileKind& kind);
  /// Whether a picture goes to standard output.
  bool writes_standard_output() const;
  /// Throws as writes() does, for each of the outputs.
  void check() const;

 private:
  struct Input {
    std::string path;
    std::optional<bool> may_be_replaced;
  };
  void check(const std::string& output) const;

  std::vector<Input> inputs_;
  std::vector<std::string> outputs_;
};

/// The scene files and all that they name, but what is not there: whoever reads it tells of that.
std::set<std::string> files_of(const Description& description);

/// Whether both names, through links too, are of one file, there or not. Throws Error(input) for an
/// empty name.
bool is_same_file(const std::string& a, const std::string& b);

}  // namespace kaustik::app
