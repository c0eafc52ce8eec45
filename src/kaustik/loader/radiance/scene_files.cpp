#include "kaustik/loader/radiance/scene_files.h"

#include <fmt/format.h>

#include "kaustik/base/file.h"
#include "kaustik/base/gzip.h"
#include "kaustik/loader/radiance/compiled_reader.h"
#include "kaustik/loader/text_places.h"

namespace kaustik::radiance {
namespace {

namespace fs = std::filesystem;

constexpr size_t most_bytes = size_t{1} << 30, most_files = 20'000;

bool is_regular(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

/// Those of a frozen one, or commands that include the files it was made from.
std::shared_ptr<const Statements> statements_of_octree(CompiledOctree octree, const Place& place) {
  for (const std::string& file : octree.files)
    octree.statements.emplace_back(
        Command{file.starts_with('!') ? file.substr(1) : fmt::format("xform \"{}\"", file), place});
  return std::make_shared<const Statements>(std::move(octree.statements));
}

}  // namespace

std::optional<fs::path> SceneFiles::find(const std::string& name, const fs::path& own_folder,
                                         const Place& place) {
  if (name.empty() || name.find('\0') != std::string::npos) return std::nullopt;
  const std::vector<fs::path> folders = {own_folder, scene_folder_, fs::path()};
  for (const fs::path& folder : folders)
    if (fs::path path = folder / name; is_regular(path)) return path;
  if (is_strict_) return std::nullopt;
  const auto like = search_.find_like(name, folders);
  if (like && is_regular(*like)) {
    deviations_.approximated(
        "file " + name,
        fmt::format("there is no file of that name: '{}' stands for it", like->string()), place);
    return like;
  }
  return std::nullopt;
}

std::optional<fs::path> SceneFiles::find_part(const std::string& name, const fs::path& own_folder,
                                              const Place& place) {
  auto path = find(name, own_folder, place);
  if (!path)
    deviations_.missing("file " + name.substr(0, 200),
                        "there is no such file beside the one that names it, nor in the folder of "
                        "the scene: it is left out (folders of RAYPATH are not searched)",
                        place);
  return path;
}

fs::path SceneFiles::found(const std::string& name, const fs::path& own_folder,
                           const Place& place) {
  if (const auto path = find(name, own_folder, place)) return *path;
  throw Error(ErrorKind::input, fmt::format("there is no file '{}'", name.substr(0, 200)),
              "name it relative to this file, or to the folder of the scene; folders of RAYPATH "
              "are not searched",
              place);
}

std::string SceneFiles::text_of(const fs::path& path, const Place& place) {
  if (++read_files_ > most_files)
    throw Error(ErrorKind::input, fmt::format("more than {} files are read", most_files),
                "put the parts into fewer files", place);
  std::vector<uint8_t> bytes;
  const size_t allowed = most_bytes - read_bytes_;
  try {
    bytes = read_file_start(path.string(), allowed + 1);
  } catch (const Error& error) {
    const Problem& problem = error.problems().front();
    throw Error(error.kind(), problem.message, problem.remedy, place);
  }
  const size_t packed = bytes.size();
  bytes = unpacked(std::move(bytes), allowed, place);
  if (bytes.size() > allowed)
    throw Error(ErrorKind::input,
                fmt::format("the files of the scene are larger than {} MiB", most_bytes >> 20),
                "leave parts out", place);
  read_bytes_ += bytes.size();
  budget_.allow_file(std::min(bytes.size(), usual_growth * packed));
  sources_.insert(path.string());
  return {bytes.begin(), bytes.end()};
}

std::shared_ptr<const Statements> SceneFiles::statements_of(const fs::path& path,
                                                            const Place& place) {
  std::error_code ignored;
  const fs::path identity = fs::weakly_canonical(path, ignored);
  auto& parsed = parsed_[identity.string()];
  if (parsed) return parsed;
  const std::string text = text_of(path, place);
  if (is_compiled(text, "Radiance_octree")) {
    parsed =
        statements_of_octree(read_octree(text, place_in(path.string())), place_in(path.string()));
    return parsed;
  }
  const bool may_be_quoted = path == trusted_ || begins_as_statements(text);
  if (text.find('\0') != std::string::npos || text.starts_with("#?RADIANCE") ||
      (!may_be_quoted && holds_statements(text)))
    throw Error(ErrorKind::input, fmt::format("'{}' is no scene of Radiance", path.string()),
                "name a text file of primitives (.rad), or an octree (.oct)", place);
  const TextPlaces places(text, path.string(), may_be_quoted);
  parsed = std::make_shared<const Statements>(
      read_statements(text, [&](size_t offset) { return places.at(offset); }));
  return parsed;
}

}  // namespace kaustik::radiance
