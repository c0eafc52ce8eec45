// make_scenes: writes scenes, or checks that what is there is what it would write.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "kaustik/base/error.h"
#include "kaustik/base/file.h"
#include "scenes/scenes.h"

namespace {

namespace fs = std::filesystem;
using namespace kaustik;
using namespace kaustik::scenes;

struct Arguments {
  std::vector<std::string> names;
  std::string output = "scenes";
  bool check = false;
  SceneOptions options;
};

void write_scene(const SceneFolder& scene, const fs::path& folder) {
  size_t bytes = 0;
  for (const SceneFile& file : scene.files()) {
    fs::create_directories((folder / file.path).parent_path());
    write_file_atomically((folder / file.path).string(), file.bytes);
    bytes += file.bytes.size();
  }
  fmt::print("{}: {} triangles in meshes, {} kB\n", folder.string(), scene.triangles(),
             (bytes + 999) / 1000);
}

/// Prints what differs and counts it.
int count_differences(const SceneFolder& scene, const fs::path& folder) {
  int differences = 0;
  std::vector<fs::path> expected;
  for (const SceneFile& file : scene.files()) {
    const fs::path path = folder / file.path;
    expected.push_back(path);
    if (fs::exists(path) && read_file(path.string()) == file.bytes) continue;
    fmt::print("{} {}\n", path.string(), fs::exists(path) ? "differs" : "is missing");
    ++differences;
  }
  for (const char* made : {"meshes", "pictures"}) {
    if (!fs::exists(folder / made)) continue;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder / made)) {
      if (std::find(expected.begin(), expected.end(), entry.path()) != expected.end()) continue;
      fmt::print("{} is not made any more\n", entry.path().string());
      ++differences;
    }
  }
  return differences;
}

const SceneMaker& maker_named(const std::string& name) {
  std::vector<std::string> names;
  for (const SceneMaker& maker : scene_makers()) {
    if (maker.name == name) return maker;
    names.push_back(maker.name);
  }
  throw Error(ErrorKind::input, fmt::format("there is no scene '{}'", name), suggest(name, names));
}

int run(const Arguments& arguments) {
  std::vector<std::string> names = arguments.names;
  if (names.empty())
    for (const SceneMaker& maker : scene_makers()) names.push_back(maker.name);
  int differences = 0;
  for (const std::string& name : names) {
    const SceneFolder scene = maker_named(name).make(arguments.options);
    const fs::path folder = fs::path(arguments.output) / name;
    if (arguments.check)
      differences += count_differences(scene, folder);
    else
      write_scene(scene, folder);
  }
  return differences > 0 ? 1 : 0;
}

std::string list_of_scenes() {
  std::string text = "Scenes:\n";
  for (const SceneMaker& maker : scene_makers())
    text += fmt::format("  {:<16} {}\n", maker.name, maker.sentence);
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App program{"Makes the scenes of scenes/ with their meshes and pictures.", "make_scenes"};
  program.footer(list_of_scenes());
  program.add_option("scenes", arguments.names, "Which scenes; all if none is named");
  program.add_option("-o,--output", arguments.output, "Folder for the scenes' folders")
      ->capture_default_str();
  program.add_flag("--check", arguments.check,
                   "Write nothing; say which files are not what would be written");
  program.add_option("--seed", arguments.options.seed, "Seed of everything random")
      ->capture_default_str();
  program
      .add_option("--maze-size", arguments.options.maze_size, "Cells along each side of the maze")
      ->check(CLI::Range(2, 60))
      ->capture_default_str();
  CLI11_PARSE(program, argc, argv);
  try {
    return run(arguments);
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return error.kind() == ErrorKind::input ? 2 : 1;
  } catch (const std::exception& error) {
    fmt::print(stderr, "make_scenes: {}\n", error.what());
    return 1;
  }
}
