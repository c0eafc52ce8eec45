#include "file_roles.h"

#include <fmt/format.h>

#include <filesystem>
#include <set>

#include "kaustik/base/file.h"
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

void add_files(const Object& object, std::set<const Object*>& seen, std::set<std::string>& files) {
  if (!seen.insert(&object).second) return;
  if (object.place.file) files.insert(*object.place.file);
  for (const Property& property : object.properties)
    if (const std::string file = file_of(property); !file.empty()) files.insert(file);
  for (const Child& child : object.children) add_files(*child.object, seen, files);
}

}  // namespace

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code failed;
  if (fs::equivalent(a, b, failed) && !failed) return true;
  return identity(a) == identity(b);
}

void FileRoles::reads(const std::string& path, std::optional<bool> may_be_replaced) {
  if (!is_standard_stream(path)) inputs_.push_back({path, may_be_replaced});
}

void FileRoles::reads(const Description& description) {
  std::set<const Object*> seen;
  std::set<std::string> files;
  add_files(*description.scene, seen, files);
  std::error_code ignored;
  // Places may be of the command line, too.
  for (const std::string& file : files)
    if (fs::exists(file, ignored)) reads(file);
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

void check_not_there(const std::string& path, bool (*is_kind)(const std::string&),
                     const std::string& what, const std::string& remedy, bool force) {
  std::error_code unknown;
  if (force || !fs::is_regular_file(path, unknown) || fs::file_size(path, unknown) == 0) return;
  if (is_kind(path))
    throw Error(ErrorKind::input, fmt::format("'{}' is there already, and is {}", path, what),
                remedy + ", or replace it: --force");
  throw Error(ErrorKind::input, fmt::format("'{}' is there already, and is not {}", path, what),
              "choose another name, or replace it: --force");
}

}  // namespace kaustik::app
