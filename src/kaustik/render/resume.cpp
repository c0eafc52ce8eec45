#include "kaustik/render/resume.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "kaustik/base/file.h"

namespace kaustik {
namespace {

namespace fs = std::filesystem;

/// As links have it; nothing if that cannot be told.
std::optional<fs::path> real_path(const fs::path& path) {
  std::error_code failed;
  const fs::path whole = fs::absolute(path, failed);
  if (failed) return {};
  const fs::path real = fs::weakly_canonical(whole, failed);
  if (failed) return {};
  return real;
}

bool lies_below(const std::optional<fs::path>& file, const std::optional<fs::path>& folder) {
  return file && folder &&
         std::mismatch(folder->begin(), folder->end(), file->begin(), file->end()).first ==
             folder->end();
}

/// "the part from pass 48 on of 64 passes in 4 parts", "passes that are not divided"
std::string text_of(uint32_t first_pass, const PassDivision& division) {
  if (!division.is_divided()) return "passes that are not divided into parts";
  return fmt::format("the part from pass {} on of {} passes in {} parts", first_pass,
                     division.whole.end - division.whole.begin, division.parts);
}

}  // namespace

SessionSettings settings_to_go_on(const Checkpoint& checkpoint) {
  const RenderRecord& record = checkpoint.record;
  SessionSettings settings;
  settings.seed = record.recipe.seed;
  settings.samples_per_pass = record.recipe.samples_per_pass;
  settings.first_pass = record.plan.first_pass;
  settings.error = record.plan.error;
  if (record.plan.passes > 0) settings.passes = record.plan.passes;
  keep_to_time(settings, record.plan.seconds, checkpoint);
  return settings;
}

void keep_to_time(SessionSettings& settings, std::optional<double> seconds,
                  const Checkpoint& checkpoint) {
  if (!seconds) return;
  const double left_s = *seconds - checkpoint.record.seconds;
  if (left_s > 0) {
    settings.seconds = left_s;
    return;
  }
  settings.seconds.reset();
  settings.samples_per_pass = checkpoint.record.recipe.samples_per_pass;
  settings.passes = checkpoint.film.passes().ranges().back().end - settings.first_pass;
}

void check_same_scene(const PreparedScene& prepared, const Checkpoint& checkpoint,
                      const std::string& path) {
  const RenderRecipe& recipe = checkpoint.record.recipe;
  FilmLayers layers = FilmLayers::of(*prepared.integrator, prepared.scene->film().layers,
                                     prepared.scene->camera().traits().are_pixels_apart());
  layers.halves = checkpoint.film.layers().halves;
  const bool same = prepared.digest == recipe.digest &&
                    checkpoint.film.is_for(prepared.scene->film().crop_size, layers);
  if (same) return;
  throw Error(
      ErrorKind::input,
      fmt::format("the scene '{}', or a file that it names, is not what it was when the passes {} "
                  "were rendered",
                  recipe.scene, checkpoint.film.passes().text()),
      "bring back the scene as it was, or render the new one from the start", place_in(path));
}

void check_same_passes(const Session& session, const Checkpoint& checkpoint,
                       const std::string& path) {
  const RenderRecord& record = checkpoint.record;
  const auto fail = [&](const std::string& message) {
    throw Error(ErrorKind::input, message,
                "ask for the same passes and samples as before, or for another checkpoint",
                place_in(path));
  };
  if (session.samples_per_pass() != record.recipe.samples_per_pass)
    fail(fmt::format("its passes have {} samples per pixel, those that are asked for have {}",
                     record.recipe.samples_per_pass, session.samples_per_pass()));
  const PassDivision &asked = session.division(), &there = record.plan.division;
  if (!asked.is_divided()) return;
  if (asked != there || session.first_pass() != record.plan.first_pass)
    fail(fmt::format("it is of {}, not of {}", text_of(record.plan.first_pass, there),
                     text_of(session.first_pass(), asked)));
}

std::vector<std::string> files_outside_its_folder(const std::vector<std::string>& files,
                                                  const std::string& checkpoint) {
  const std::optional<fs::path> folder = real_path(fs::path(checkpoint).parent_path() / ".");
  std::vector<std::string> outside;
  for (const std::string& file : files)
    if (!lies_below(real_path(output_target(file)), folder)) outside.push_back(file);
  return outside;
}

}  // namespace kaustik
