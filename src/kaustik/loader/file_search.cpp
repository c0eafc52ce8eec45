#include "kaustik/loader/file_search.h"

#include <algorithm>
#include <string_view>
#include <system_error>

#include "kaustik/base/text_lines.h"
#include "kaustik/loader/lower_case.h"

namespace kaustik {
namespace {

namespace fs = std::filesystem;

constexpr size_t most_folders_listed = 200, most_names_of_folder = 20000, most_searches = 5000;
constexpr size_t most_parts = 4;  ///< of the name of a file of another computer

/// Of pictures that Kaustik reads, in the order in which they are taken …
constexpr std::string_view readable_pictures[] = {".exr",  ".hdr", ".pfm", ".png",  ".tif",
                                                  ".tiff", ".tga", ".bmp", ".webp", ".jpg",
                                                  ".jpeg", ".ppm", ".pgm"};
/// … and of others.
constexpr std::string_view other_pictures[] = {".dds", ".gif", ".psd", ".rgbe", ".tx", ".ktx"};

bool is_absolute_anywhere(std::string_view name) {
  const bool has_drive =
      name.size() > 2 && name[1] == ':' && std::isalpha(static_cast<unsigned char>(name[0])) != 0;
  return has_drive || name.starts_with('/') || name.starts_with('\\');
}

bool is_picture(const fs::path& path) {
  const std::string suffix = lower_case(path.extension().string());
  const auto has = [&](const auto& suffixes) {
    return std::find(std::begin(suffixes), std::end(suffixes), suffix) != std::end(suffixes);
  };
  return has(readable_pictures) || has(other_pictures);
}

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

/// A folder and what is looked for in it.
struct Candidate {
  fs::path folder, relative;
};

/// Its last parts, the longest first.
std::vector<fs::path> ends_of(const fs::path& path) {
  std::vector<fs::path> ends;
  fs::path end = path.filename();
  for (fs::path before = path.parent_path(); ends.size() < most_parts;
       before = before.parent_path()) {
    ends.insert(ends.begin(), end);
    const fs::path part = before.filename();
    if (part.empty() || part == "." || part == ".." || part.string().ends_with(':')) break;
    end = part / end;
  }
  return ends;
}

/// Where a file of that name may be.
std::vector<Candidate> candidates_for(const std::string& name,
                                      const std::vector<fs::path>& folders) {
  std::string clean(trimmed(name));
  std::replace(clean.begin(), clean.end(), '\\', '/');
  std::vector<Candidate> candidates;
  if (clean.empty() || clean.ends_with('/')) return candidates;
  const fs::path path(clean);
  const bool is_absolute = is_absolute_anywhere(trimmed(name));
  if (path.is_absolute()) candidates.push_back({path.parent_path(), path.filename()});
  for (const fs::path& relative : is_absolute ? ends_of(path) : std::vector<fs::path>{path})
    for (const fs::path& folder : folders) candidates.push_back({folder, relative});
  return candidates;
}

}  // namespace

const FileSearch::Listing& FileSearch::listing_of(const fs::path& folder) {
  static const Listing none;
  const auto known = listed_.find(folder);
  if (known != listed_.end()) return known->second;
  if (listed_.size() >= most_folders_listed) return none;
  Listing& listing = listed_[folder];
  std::error_code failure;
  fs::directory_iterator entry(folder.empty() ? fs::path(".") : folder, failure);
  for (;
       !failure && entry != fs::directory_iterator() && listing.names.size() < most_names_of_folder;
       entry.increment(failure))
    listing.names.insert(entry->path().filename().string());
  for (const std::string& name : listing.names)
    listing.by_small_letters.try_emplace(lower_case(name), name);
  return listing;
}

std::optional<fs::path> FileSearch::find_in_any_case(const fs::path& folder,
                                                     const fs::path& relative) {
  fs::path at = folder;
  for (const fs::path& part : relative) {
    const std::string name = part.string();
    const Listing& listing = listing_of(at);
    if (name == "." || name == ".." || listing.names.contains(name)) {
      at /= part;
      continue;
    }
    const auto like = listing.by_small_letters.find(lower_case(name));
    if (like == listing.by_small_letters.end()) return std::nullopt;
    at /= like->second;
  }
  return is_file(at) ? std::optional(at.lexically_normal()) : std::nullopt;
}

std::optional<fs::path> FileSearch::find_other_picture(const fs::path& folder,
                                                       const fs::path& relative) {
  for (const std::string_view suffix : readable_pictures) {
    fs::path other = relative;
    other.replace_extension(fs::path(suffix));
    if (auto found = find_in_any_case(folder, other)) return found;
  }
  return std::nullopt;
}

std::optional<fs::path> FileSearch::find_like(const std::string& name,
                                              const std::vector<fs::path>& folders) {
  if (++searches_ > most_searches) return std::nullopt;
  const std::vector<Candidate> candidates = candidates_for(name, folders);
  for (const Candidate& candidate : candidates)
    if (is_file(candidate.folder / candidate.relative))
      return (candidate.folder / candidate.relative).lexically_normal();
  for (const Candidate& candidate : candidates)
    if (auto found = find_in_any_case(candidate.folder, candidate.relative)) return found;
  for (const Candidate& candidate : candidates)
    if (is_picture(candidate.relative))
      if (auto found = find_other_picture(candidate.folder, candidate.relative)) return found;
  return std::nullopt;
}

}  // namespace kaustik
