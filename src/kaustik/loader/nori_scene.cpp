#include "kaustik/loader/nori_scene.h"

#include <fmt/format.h>

#include <filesystem>

#include "kaustik/base/error.h"
#include "kaustik/base/file.h"
#include "kaustik/base/gzip.h"
#include "kaustik/loader/nori/scenes.h"
#include "kaustik/loader/nori/tests.h"
#include "kaustik/loader/reader_definitions.h"
#include "kaustik/loader/xml_scan.h"

namespace kaustik {
namespace {

constexpr size_t most_nori_bytes = size_t{256} << 20;

/// Whether a tag of that name begins at `at`.
bool is_tag_at(std::string_view text, size_t at, std::string_view name) {
  return text.substr(at + 1, name.size()) == name &&
         end_of_name(text, at + 1) == at + 1 + name.size();
}

/// Of the elements that begin in the text, outside of comments; the first is the root.
struct SeenTags {
  bool has_version = false, has_nori = false, has_mitsuba = false;
};

SeenTags seen_tags(std::string_view text) {
  constexpr std::string_view of_nori[] = {"mesh", "camera"};
  constexpr std::string_view of_mitsuba[] = {"sensor", "film",    "rgb",     "srgb", "spectrum",
                                             "ref",    "include", "default", "path", "alias"};
  SeenTags seen;
  bool is_root = true;
  for (size_t at = text.find('<'); at < text.size();) {
    const bool is_special = text.substr(at + 1, 1) == "!" || text.substr(at + 1, 1) == "?";
    const size_t end = is_special ? end_of_special(text, at) : end_of_tag(text, at);
    if (end == text.npos) break;
    if (!is_special) {
      if (is_root) seen.has_version = text.substr(at, end - at).find(" version") != text.npos;
      is_root = false;
      for (const std::string_view name : of_nori) seen.has_nori |= is_tag_at(text, at, name);
      for (const std::string_view name : of_mitsuba) seen.has_mitsuba |= is_tag_at(text, at, name);
    }
    at = text.find('<', end);
  }
  return seen;
}

std::string text_of_nori(const std::string& path) {
  std::vector<uint8_t> bytes;
  try {
    bytes = read_file_start(path, most_nori_bytes + 1);
  } catch (const Error& error) {
    const Problem& problem = error.problems().front();
    throw Error(error.kind(), problem.message, problem.remedy, place_in(path));
  }
  bytes = unpacked(std::move(bytes), most_nori_bytes, place_in(path));
  if (bytes.size() > most_nori_bytes)
    throw Error(ErrorKind::input,
                fmt::format("the file is larger than {} MiB", most_nori_bytes >> 20),
                "keep meshes in OBJ files", place_in(path));
  return {bytes.begin(), bytes.end()};
}

Description nori_scene_of(std::string text, const std::string& name,
                          const std::filesystem::path& folder, const LoadOptions& options) {
  const ReaderDefinitions none(options, {});
  const auto root = nori::read_elements(std::move(text), name);
  if (root->family == "test")
    throw Error(ErrorKind::input, "the file holds tests, not a scene to be rendered",
                "run them: kaustik test FILE", root->place);
  nori::Reading reading(folder, options.is_strict);
  Description description{nori::scene_of(*root, reading).scene};
  description.sources.push_back(name);
  description.is_strict = options.is_strict;
  reading.deviations.finish(description, options.is_strict);
  return description;
}

}  // namespace

bool is_nori(std::string_view head) {
  const std::string root = root_tag(head);
  if (root == "test") return true;
  if (root != "scene") return false;
  const SeenTags seen = seen_tags(head);
  return !seen.has_version && seen.has_nori && !seen.has_mitsuba;
}

Description load_nori(const std::string& path, const LoadOptions& options) {
  return nori_scene_of(text_of_nori(path), path, std::filesystem::path(path).parent_path(),
                       options);
}

Description parse_nori(std::string_view text, std::string name_for_messages,
                       const std::string& base_folder, const LoadOptions& options) {
  return nori_scene_of(std::string(text), name_for_messages, base_folder, options);
}

std::vector<NoriTest> read_nori_tests(const std::string& path, const LoadOptions& options) {
  const auto root = nori::read_elements(text_of_nori(path), path);
  if (root->family != "test")
    throw Error(ErrorKind::input, "the file holds no tests of Nori",
                "give one whose root is <test type=\"ttest\"> or <test type=\"chi2test\">",
                place_in(path));
  nori::Reading reading(std::filesystem::path(path).parent_path(), options.is_strict);
  reading.has_box_filter = true;
  std::vector<NoriTest> tests = nori::tests_of(*root, reading);
  for (NoriTest& test : tests) test.description.sources.push_back(path);
  // Of all scenes; who shows them does so once.
  reading.deviations.finish(tests.front().description, options.is_strict);
  return tests;
}

}  // namespace kaustik
