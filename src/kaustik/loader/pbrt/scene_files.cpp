#include "kaustik/loader/pbrt/scene_files.h"

#include <fmt/format.h>

#include <algorithm>

#include "kaustik/base/file.h"
#include "kaustik/base/gzip.h"

namespace kaustik::pbrt {
namespace {

namespace fs = std::filesystem;

constexpr size_t most_bytes = size_t{8} << 30;
/// Of files that are included again.
constexpr size_t most_repeated_bytes = size_t{64} << 20;
constexpr size_t most_includes = 100'000;
constexpr size_t most_depth = 64;
/// What is made of a text may take so much, and so much for each of its bytes.
constexpr size_t always_allowed = size_t{256} << 20, allowed_per_byte = 200;

fs::path identity(const fs::path& path) {
  std::error_code ignored;
  const fs::path canonical = fs::weakly_canonical(path, ignored);
  return canonical.empty() ? path : canonical;
}

bool is_regular(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

/// Without the mark of UTF-8, blanks and comments that it begins with.
std::string_view behind_comments(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  while (!text.empty()) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n\f"), text.size()));
    if (!text.starts_with('#')) break;
    text.remove_prefix(std::min(text.find('\n'), text.size()));
  }
  return text;
}

}  // namespace

bool begins_as_pbrt(std::string_view text) {
  text = behind_comments(text);
  return is_directive(text.substr(0, text.find_first_of(" \t\r\n\"[#")));
}

SceneFiles::SceneFiles(fs::path folder, bool is_strict, Deviations& deviations)
    : folder_(std::move(folder)), is_strict_(is_strict), deviations_(deviations) {}

std::vector<uint8_t> SceneFiles::bytes_of(const fs::path& path, size_t most, const Place& place) {
  try {
    std::vector<uint8_t> bytes = unpacked(read_file_start(path.string(), most + 1), most, place);
    if (bytes.size() <= most) return bytes;
    throw Error(ErrorKind::input, fmt::format("the file has more than {} bytes", most),
                "give it in smaller parts", place);
  } catch (const Error& error) {
    const Problem& problem = error.problems().front();
    throw Error(error.kind(), problem.message, problem.remedy, place);
  }
}

SourceText SceneFiles::keep(std::vector<uint8_t> bytes, const std::string& name) {
  const auto owner = std::make_shared<const std::vector<uint8_t>>(std::move(bytes));
  const std::string_view text(reinterpret_cast<const char*>(owner->data()), owner->size());
  read_bytes_ += text.size();
  return {std::make_shared<const std::string>(name), text, owner};
}

SourceText SceneFiles::main_file(const std::string& path) {
  open_.push_back(identity(path));
  sources_.insert(path);
  return keep(bytes_of(path, most_bytes, place_in(path)), path);
}

SourceText SceneFiles::main_text(std::string_view text, const std::string& name) {
  read_bytes_ += text.size();
  return {std::make_shared<const std::string>(name), text, nullptr};
}

SourceText SceneFiles::included(const fs::path& path, const Place& place) {
  const auto [entry, is_new] = texts_.try_emplace(identity(path));
  if (!is_new) {
    repeated_bytes_ += entry->second.text.size();
    if (repeated_bytes_ > most_repeated_bytes)
      throw Error(ErrorKind::input,
                  fmt::format("files are included again and again: more than {} MiB beyond them",
                              most_repeated_bytes >> 20),
                  "include each once, and place its objects by ObjectInstance", place);
    return entry->second;
  }
  std::vector<uint8_t> bytes = bytes_of(path, most_bytes - read_bytes_, place);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (!behind_comments(text).empty() && !begins_as_pbrt(text))
    throw Error(ErrorKind::input, fmt::format("{} is no scene of pbrt", shown(path.string())),
                "include files that begin with a directive", place);
  sources_.insert(path.string());
  return entry->second = keep(std::move(bytes), path.string());
}

SceneFiles::Opened::Opened(SceneFiles& files, const std::string& name, const Place& place)
    : files_(files) {
  const auto refuse = [&](const std::string& message, const std::string& remedy) {
    throw Error(ErrorKind::input, message, remedy, place);
  };
  const std::optional<fs::path> path = files.find(name, place);
  if (!path) refuse(fmt::format("there is no file {}", shown(name)), where_files_lie);
  if (std::ranges::find(files.open_, identity(*path)) != files.open_.end())
    refuse(fmt::format("{} includes itself", shown(path->string())),
           "remove one of the includes that lead round");
  if (files.open_.size() >= most_depth)
    refuse(fmt::format("includes nest more than {} files deep", most_depth),
           "include the parts from one file");
  if (++files.includes_ > most_includes)
    refuse(fmt::format("more than {} files are included", most_includes),
           "put the parts into fewer files");
  source_ = files.included(*path, place);
  files.open_.push_back(identity(*path));
}

std::optional<fs::path> SceneFiles::find(const std::string& name, const Place& place) {
  const auto [entry, is_new] = found_.try_emplace(name);
  if (!is_new || name.empty()) return entry->second;
  const fs::path direct = folder_ / name;  // an absolute name stays as it is
  if (is_regular(direct)) return entry->second = direct;
  if (is_strict_) return std::nullopt;
  std::string with_slashes = name;
  std::replace(with_slashes.begin(), with_slashes.end(), '\\', '/');
  auto like = is_regular(folder_ / with_slashes) ? std::optional(folder_ / with_slashes)
                                                 : search_.find_like(name, {folder_});
  if (like)
    deviations_.approximated(
        fmt::format("file {}", shown(name)),
        fmt::format("it is not there: {} stands for it", shown(like->string())), place);
  return entry->second = like;
}

void SceneFiles::spend(size_t bytes, const Place& place) {
  spent_bytes_ += bytes;
  if (spent_bytes_ <= always_allowed + allowed_per_byte * read_bytes_) return;
  throw Error(ErrorKind::input,
              fmt::format("shapes and attributes take more than {} MiB", spent_bytes_ >> 20),
              "place alike ones by ObjectInstance, or give fewer levels", place);
}

}  // namespace kaustik::pbrt
