#include "kaustik/loader/pbrt_scene.h"

#include <fmt/format.h>

#include <filesystem>

#include "kaustik/loader/deviations.h"
#include "kaustik/loader/pbrt/directives.h"

namespace kaustik {
namespace {

Description scene_of(pbrt::SceneFiles& files, Deviations& deviations, const pbrt::SourceText& text,
                     const LoadOptions& options) {
  Description description;
  pbrt::Directives directives(files, deviations);
  directives.run(text);
  directives.finish({text.name, 0, 0}, description);
  description.is_strict = options.is_strict;
  for (const auto& [name, value] : options.definitions)
    description.warnings.push_back(
        fmt::format("a scene of pbrt has no definitions: '{}{}={}' has no effect",
                    options.definition_prefix, name, value));
  deviations.finish(description, options.is_strict);
  return description;
}

}  // namespace

bool is_pbrt(std::string_view head) { return pbrt::begins_as_pbrt(head); }

Description load_pbrt(const std::string& path, const LoadOptions& options) {
  Deviations deviations;
  pbrt::SceneFiles files(std::filesystem::path(path).parent_path(), options.is_strict, deviations);
  return scene_of(files, deviations, files.main_file(path), options);
}

Description parse_pbrt(std::string_view text, std::string name_for_messages,
                       const std::string& base_folder, const LoadOptions& options) {
  Deviations deviations;
  pbrt::SceneFiles files(base_folder, options.is_strict, deviations);
  return scene_of(files, deviations, files.main_text(text, name_for_messages), options);
}

}  // namespace kaustik
