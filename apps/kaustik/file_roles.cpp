#include "file_roles.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "kaustik/base/file.h"
#include "kaustik/integrator/description_types.h"
#include "standard_streams.h"

namespace kaustik::app {
namespace {

namespace fs = std::filesystem;

fs::path identity(const std::string& path) {
  if (path.empty())
    throw Error(ErrorKind::input, "the name of a file is empty", "give a file name");
  std::error_code failed;
  const fs::path target = fs::absolute(output_target(path), failed);
  if (failed)
    throw Error(ErrorKind::system,
                fmt::format("cannot tell where '{}' is: {}", path, failed.message()),
                "give the whole path of the file");
  const fs::path canonical = fs::weakly_canonical(target, failed);
  return failed ? target : canonical;
}

/// Whether there is something that would be lost.
bool has_contents(const std::string& path) {
  std::error_code unknown;
  return fs::is_regular_file(path, unknown) && fs::file_size(path, unknown) > 0;
}

}  // namespace

const FileKind any_file = {"a file with contents", [](const std::string&) { return true; }};

std::set<std::string> files_of(const Description& description) {
  std::set<std::string> files = named_files(description, description_types());
  std::error_code ignored;
  std::erase_if(files, [&](const std::string& file) { return !fs::exists(file, ignored); });
  files.insert(description.sources.begin(), description.sources.end());
  return files;
}

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code failed;
  if (fs::equivalent(a, b, failed) && !failed) return true;
  return identity(a) == identity(b);
}

void FileRoles::reads(const std::string& path, std::optional<bool> may_be_replaced) {
  if (is_standard_stream(path))
    throw Error(ErrorKind::input,
                fmt::format("'{}' is standard input, from which only scenes are read", path),
                "give the name of a file (one that is called so: ./" + path + ")");
  inputs_.push_back({path, may_be_replaced});
}

void FileRoles::reads_scene(const std::string& path) {
  if (!is_standard_stream(path)) reads(path);
}

void FileRoles::reads(const Description& description) {
  for (const std::string& file : files_of(description)) reads_scene(file);
}

void FileRoles::writes(const std::string& path) {
  for (const std::string& other : outputs_)
    if (is_standard_stream(path) ? is_standard_stream(other)
                                 : !is_standard_stream(other) && is_same_file(path, other))
      throw Error(ErrorKind::input,
                  path == other ? fmt::format("'{}' would be written twice", path)
                                : fmt::format("'{}' and '{}' are one file, which would be "
                                              "written twice",
                                              other, path),
                  "give every output a name of its own");
  check(path);
  outputs_.push_back(path);
}

void FileRoles::writes(const std::string& path, const FileKind& kind, Replacing replacing,
                       const std::string& if_of_kind) {
  if (is_standard_stream(path))
    throw Error(
        ErrorKind::input,
        fmt::format("'{}' is standard output, which takes pictures only, not {}", path, kind.name),
        "give the name of a file (one that is called so: ./" + path + ")");
  check_output_path(path);
  writes(path);
  if (replacing == Replacing::anything || !has_contents(path)) return;
  const bool is_of_kind = kind.is_one(path);
  if (is_of_kind && replacing == Replacing::own_kind) return;
  throw Error(
      ErrorKind::input,
      fmt::format("'{}' is there already, and is {}{}", path, is_of_kind ? "" : "not ", kind.name),
      (is_of_kind ? if_of_kind : "choose another name") + ", or replace it: --force");
}

void FileRoles::writes_stream(const std::string& path, const FileKind& kind) {
  std::error_code unknown;
  const fs::file_status status = fs::status(path, unknown);
  if (!fs::exists(status) || fs::is_regular_file(status) || fs::is_directory(status))
    return writes(path, kind, Replacing::own_kind, "");
  writes(path);
}

bool FileRoles::writes_standard_output() const {
  return std::any_of(outputs_.begin(), outputs_.end(), is_standard_stream);
}

void FileRoles::check() const {
  for (const std::string& output : outputs_) check(output);
}

void FileRoles::check(const std::string& output) const {
  if (is_standard_stream(output)) return;
  for (const Input& input : inputs_) {
    if (input.may_be_replaced.value_or(false) || !is_same_file(input.path, output)) continue;
    throw Error(ErrorKind::input,
                fmt::format("'{}' is read by this command: writing it would replace it", output),
                input.may_be_replaced ? "choose another name for the output, or replace it: --force"
                                      : "choose another name for the output");
  }
}

}  // namespace kaustik::app
