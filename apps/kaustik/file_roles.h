#pragma once
#include <optional>
#include <string>
#include <vector>

#include "kaustik/base/error.h"
#include "kaustik/scene/description.h"

namespace kaustik::app {

/// The files that a command reads and writes. To be checked before long work: nothing that it reads
/// may be replaced, and nothing may be written twice, under whatever names and links. Standard
/// input and output ("-") are no files.
class FileRoles {
 public:
  /// `may_be_replaced`: by --force, which was given or not.
  void reads(const std::string& path, std::optional<bool> may_be_replaced = {});
  /// The scene files and all that they name.
  void reads(const Description& description);
  /// Throws Error(input) if another output, or something that is read, is this file.
  void writes(const std::string& path);
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

/// Whether both names, through links too, are of one file, there or not. Throws Error(input) for an
/// empty name.
bool is_same_file(const std::string& a, const std::string& b);

/// Throws Error(input) if something stands at `path` but an empty file, unless `force`. `is_kind`
/// tells whether it is `what`, such as "a checkpoint", and `remedy` what to do if so.
void check_not_there(const std::string& path, bool (*is_kind)(const std::string&),
                     const std::string& what, const std::string& remedy, bool force);

}  // namespace kaustik::app
