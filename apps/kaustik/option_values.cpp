#include "option_values.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <utility>

#include "kaustik/loader/scene_format.h"

namespace kaustik::app {
namespace {

/// CLI11 keeps no more than a name for the values of an option.
std::map<const CLI::Option*, std::function<OptionValues()>>& told_values() {
  static std::map<const CLI::Option*, std::function<OptionValues()>> values;
  return values;
}

}  // namespace

CLI::Option* takes_files(CLI::Option* option, const std::vector<std::string>& extensions) {
  told_values()[option] = [extensions] {
    return OptionValues{OptionValues::Kind::files, extensions};
  };
  return takes(option, "FILE");
}

CLI::Option* takes_words(CLI::Option* option, const std::vector<std::string>& words) {
  return takes_words(option, words, fmt::format("{}", fmt::join(words, "|")));
}

CLI::Option* takes_words(CLI::Option* option, const std::vector<std::string>& words,
                         const std::string& name) {
  return takes_words_of(
      option, [words] { return words; }, name);
}

CLI::Option* takes_words_of(CLI::Option* option, std::function<std::vector<std::string>()> words,
                            const std::string& name) {
  told_values()[option] = [words = std::move(words)] {
    return OptionValues{OptionValues::Kind::words, words()};
  };
  return takes(option, name);
}

CLI::Option* takes(CLI::Option* option, const std::string& name) { return option->type_name(name); }

OptionValues values_of(const CLI::Option* option) {
  const auto found = told_values().find(option);
  return found == told_values().end() ? OptionValues{} : found->second();
}

const std::vector<std::string>& scene_extensions() {
  static const std::vector<std::string> extensions = [] {
    std::vector<std::string> all;
    for (const SceneFormat& format : scene_formats())
      for (const std::string_view extension : format.extensions)
        for (const char* const packing : {"", ".gz"}) {
          const std::string name = std::string(extension.substr(1)) + packing;
          // Two formats may share one.
          if (std::ranges::find(all, name) == all.end()) all.push_back(name);
        }
    return all;
  }();
  return extensions;
}

const std::vector<std::string>& picture_extensions() {
  static const std::vector<std::string> extensions{
      "exr", "hdr", "pfm", "tif", "tiff", "png", "jpg", "jpeg", "webp", "bmp", "tga", "ppm", "pgm"};
  return extensions;
}

const std::vector<std::string>& written_extensions() {
  static const std::vector<std::string> extensions{"exr", "hdr", "pfm",  "tif", "tiff",
                                                   "png", "jpg", "jpeg", "ppm"};
  return extensions;
}

const std::vector<std::string>& rendered_extensions() {
  static const std::vector<std::string> extensions = [] {
    std::vector<std::string> all = written_extensions();
    all.emplace_back("csv");
    return all;
  }();
  return extensions;
}

const std::vector<std::string>& shown_extensions() {
  static const std::vector<std::string> extensions{"png", "jpg", "jpeg", "ppm", "tif", "tiff"};
  return extensions;
}

}  // namespace kaustik::app
