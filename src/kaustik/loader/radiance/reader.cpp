#include "kaustik/loader/radiance/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "kaustik/base/error.h"
#include "kaustik/loader/radiance/generators.h"
#include "kaustik/loader/radiance/placement.h"

namespace kaustik::radiance {
namespace {

namespace fs = std::filesystem;

constexpr int deepest_include = 50;
constexpr size_t most_includes = 100'000;

fs::path identity_of(const fs::path& path) {
  std::error_code ignored;
  return fs::weakly_canonical(path, ignored);
}

std::vector<std::string> lines_of_text(const std::string& text) {
  std::vector<std::string> lines;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    std::string line = text.substr(begin, end - begin);
    if (!line.empty() && line[0] != '#') lines.push_back(std::move(line));
    begin = end + 1;
  }
  return lines;
}

[[noreturn]] void refuse_command(const std::string& program, const Place& place) {
  throw Error(
      ErrorKind::input,
      fmt::format("the scene runs the command '{}', which is not built in", program.substr(0, 60)),
      fmt::format("commands of scenes are never run: let Radiance write the scene without "
                  "them, 'xform -e scene.rad > flat.rad', and render that. Built in: {}",
                  generator_names()),
      place);
}

/// What a statement takes when it is placed once more.
size_t bytes_of(const Primitive& primitive) {
  return 64 + 24 * primitive.reals.size() + (kind_of(primitive.type) == Kind::surface ? 100 : 600);
}

}  // namespace

SceneReader::SceneReader(SceneFiles& files, Deviations& deviations, Object& scene)
    : files_(files),
      deviations_(deviations),
      patterns_(files, deviations),
      materials_(patterns_, deviations),
      surfaces_(materials_, deviations, scene),
      environment_(patterns_, deviations),
      scene_(scene) {}

void SceneReader::read_file(const fs::path& path, const Place& place) {
  walk_file(path, {{}, false, std::nullopt, std::nullopt, path.parent_path()}, place);
}

void SceneReader::read_statements_of(const Statements& statements, const fs::path& folder) {
  walk(std::make_shared<const Statements>(statements),
       {{}, false, std::nullopt, std::nullopt, folder});
}

void SceneReader::walk_file(const fs::path& path, const Frame& frame, const Place& place) {
  fs::path& known = identities_[path.string()];
  if (known.empty()) known = identity_of(path);
  const fs::path identity = known;
  if (++includes_ > most_includes)
    throw Error(ErrorKind::input, fmt::format("more than {} files are included", most_includes),
                "place the parts by arrays (xform -a), or put them into fewer files", place);
  if (std::find(open_.begin(), open_.end(), identity) != open_.end())
    throw Error(ErrorKind::input,
                fmt::format("'{}' includes itself, by way of what it includes", path.string()),
                "no file can include itself: remove one of the commands", place);
  if (open_.size() >= deepest_include)
    throw Error(ErrorKind::input, fmt::format("files include one another {} deep", deepest_include),
                "include the parts from one file", place);
  open_.push_back(identity);
  Frame inner = frame;
  inner.folder = path.parent_path();
  walk(files_.statements_of(path, place), inner);
  open_.pop_back();
}

void SceneReader::walk(const std::shared_ptr<const Statements>& statements, const Frame& frame) {
  if (++depth_ > 2 * deepest_include)
    throw Error(ErrorKind::input, "commands write commands that write commands, without end",
                "make the scene flatter", {});
  for (const Statement& statement : *statements) {
    if (const auto* primitive = std::get_if<Primitive>(&statement))
      read(std::shared_ptr<const Primitive>(statements, primitive), frame);
    else
      run(std::get<Command>(statement), frame);
  }
  --depth_;
}

void SceneReader::stand_in_for(const std::string& modifier, const Place& place) {
  if (!modifiers_.is_unheard_of(modifier)) return;
  Primitive paint;
  paint.modifier = "void";
  paint.type = "plastic";
  paint.id = modifier;
  paint.reals = {0.5, 0.5, 0.5, 0, 0};
  paint.place = place;
  deviations_.missing(
      fmt::format("modifier '{}'", modifier.substr(0, 60)),
      "nothing defines it before: grey paint stands for it (a .rif file names the materials, too)",
      place);
  modifiers_.define_stand_in(std::make_shared<const Primitive>(std::move(paint)));
}

ModifierPointer SceneReader::modifier_of(const Primitive& surface, const Frame& frame) {
  if (frame.given) return *frame.given;
  const std::string& name = frame.modifier ? *frame.modifier : surface.modifier;
  stand_in_for(name, surface.place);
  return modifiers_.find(name, surface.place);
}

void SceneReader::read(const std::shared_ptr<const Primitive>& primitive, const Frame& frame) {
  try {
    read_checked(primitive, frame);
  } catch (const std::invalid_argument&) {
    throw Error(ErrorKind::input,
                fmt::format("{} is larger or smaller than numbers go", name_of(*primitive)),
                "check its numbers, and the transforms that place it", primitive->place);
  }
}

void SceneReader::read_checked(const std::shared_ptr<const Primitive>& primitive,
                               const Frame& frame) {
  files_.budget().spend(bytes_of(*primitive), primitive->place);
  const Kind kind = kind_of(primitive->type);
  if (kind == Kind::alias) stand_in_for(primitive->strings.at(0), primitive->place);
  if (kind != Kind::surface) return modifiers_.define(primitive, frame.placed);
  if (primitive->type == "instance") return place_octree(*primitive, frame);
  if (primitive->type == "mesh") return place_mesh(primitive, frame);
  const ModifierPointer modifier = modifier_of(*primitive, frame);
  if (primitive->type == "source")
    return environment_.add(*primitive, frame.placed, modifier.get());
  surfaces_.add({primitive.get(), frame.placed, frame.is_inverted, modifier.get()});
}

std::vector<SceneReader::Frame> SceneReader::frames_of(const Words& words, const Frame& frame,
                                                       const Place& place,
                                                       std::vector<std::string>& files) {
  const Placing placing = read_xform(words, place, [&](const std::string& file) {
    return lines_of_text(files_.text_of(files_.found(file, frame.folder, place), place));
  });
  files = placing.files;
  std::vector<Frame> frames;
  frames.reserve(placing.placements.size());
  for (const Transform& placement : placing.placements)
    frames.push_back({frame.placed * placement, frame.is_inverted != placing.is_inverted,
                      frame.modifier ? frame.modifier : placing.modifier, frame.given,
                      frame.folder});
  return frames;
}

void SceneReader::run(const Command& command, const Frame& frame) {
  try {
    run_programs(command, frame);
  } catch (const std::invalid_argument&) {
    throw Error(ErrorKind::input, "transforms make the scene larger than numbers go",
                "check the factors of 'xform -s'", command.place);
  }
}

/// The last program of a line places what those before it write.
void SceneReader::run_programs(const Command& command, const Frame& frame) {
  const Place& place = command.place;
  files_.budget().spend(256 + command.text.size(), place);
  std::vector<Words> programs = split_command(command.text, place);
  std::vector<Frame> frames = {frame};
  std::vector<std::string> files;
  // From the last one on: each xform places what comes before it.
  while (!programs.empty() && programs.back().front() == "xform") {
    std::vector<Frame> placed;
    files.clear();
    for (const Frame& outer : frames) {
      std::vector<Frame> inner = frames_of(programs.back(), outer, place, files);
      if (placed.size() + inner.size() > most_placements)
        throw Error(ErrorKind::input, "the commands make too many copies", "make arrays smaller",
                    place);
      files_.budget().spend(sizeof(Frame) * inner.size(), place);
      placed.insert(placed.end(), inner.begin(), inner.end());
    }
    frames = std::move(placed);
    programs.pop_back();
    if (files.empty() || files.front().empty()) continue;
    if (!programs.empty())
      throw Error(ErrorKind::input, "'xform' names a file, and a program writes for it, too",
                  "leave out one of the two", place);
    for (const Frame& inner : frames)
      for (const std::string& file : files)
        if (const auto path = files_.find_part(file, frame.folder, place))
          walk_file(*path, inner, place);
    return;
  }
  if (programs.empty())
    throw Error(ErrorKind::input, "'xform' names no file", "write xform -t x y z file.rad", place);
  const auto read_text = [&](const std::string& file) {
    return files_.text_of(files_.found(file, frame.folder, place), place);
  };
  const auto read_part = [&](const std::string& file) {
    const auto path = files_.find_part(file, frame.folder, place);
    std::string text = path ? files_.text_of(*path, place) : std::string();
    files_.budget().spend(4 * text.size(), place);
    return text;
  };
  GeneratorContext context{place, read_text, read_part, std::nullopt, deviations_};
  for (const Words& program : programs) {
    auto text = run_generator(program, context);
    if (!text) refuse_command(program.front(), place);
    files_.budget().spend(4 * text->size(), place);
    context.input = std::move(text);
  }
  const auto statements = std::make_shared<const Statements>(
      read_statements(*context.input, [&](size_t) { return place; }));
  for (const Frame& inner : frames) walk(statements, inner);
}

void SceneReader::finish() {
  surfaces_.finish();
  materials_.finish();
  environment_.finish(scene_);
}

}  // namespace kaustik::radiance
