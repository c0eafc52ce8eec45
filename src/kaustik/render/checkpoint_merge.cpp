#include "kaustik/render/checkpoint_merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "kaustik/render/program_version.h"

namespace kaustik {
namespace {

/// What tells two recipes apart, and how to make them alike; "" if nothing does.
std::pair<std::string, std::string> difference(const RenderRecipe& a, const RenderRecipe& b) {
  if (a.digest.scene != b.digest.scene)
    return {"another scene, or one that was changed",
            "render all parts of one scene file, with the same definitions and settings"};
  if (a.digest.integrator != b.digest.integrator)
    return {"another integrator, or other parameters of it",
            "render all parts by the same integrator with the same settings"};
  if (a.seed != b.seed)
    return {fmt::format("seed {} instead of {}", b.seed, a.seed),
            "render all parts with the same seed"};
  if (a.samples_per_pass != b.samples_per_pass)
    return {
        fmt::format("{} samples per pass instead of {}", b.samples_per_pass, a.samples_per_pass),
        "give the passes of all parts the same number of samples per pixel"};
  if (a.lessons != b.lessons) return {"other lessons", "give all parts the same lessons, or none"};
  return {};
}

/// What has to be the same in all parts.
struct Kind {
  RenderRecipe recipe;
  Vec2i size;
  FilmLayers layers;
};
Kind kind_of(const RenderRecord& record, const Film& film) {
  return {record.recipe, {film.width(), film.height()}, film.layers()};
}
Kind kind_of(const CheckpointReader& reader) {
  return {reader.record().recipe, reader.film_head().size, reader.film_head().layers};
}

[[noreturn]] void refuse(const std::string& path, const std::string& message,
                         const std::string& remedy) {
  throw Error(ErrorKind::input, message, remedy, place_in(path));
}

void check_same_kind(const Kind& whole, const std::string& whole_path, const Kind& part,
                     const std::string& path) {
  const auto [what, remedy] = difference(whole.recipe, part.recipe);
  if (!what.empty())
    refuse(path, fmt::format("this cannot be merged with '{}': it has {}", whole_path, what),
           remedy);
  if (!(whole.size == part.size) || !(whole.layers == part.layers))
    refuse(path,
           fmt::format("this cannot be merged with '{}': its picture has another size or other "
                       "components",
                       whole_path),
           "render all parts of one scene file, with the same definitions and settings");
}

void check_passes_are_new(const PassSet& there, const PassSet& more, const std::string& path) {
  const PassSet twice = there.common(more);
  if (!twice.empty())
    refuse(path, fmt::format("of its passes {} were given before: {}", more.text(), twice.text()),
           "give each pass once: parts have passes of their own");
}

void check_regions_are_new(const PassSet& twice, const std::string& path) {
  if (!twice.empty())
    refuse(path,
           fmt::format("of the passes of its regions {} were given before, for the same pixels",
                       twice.text()),
           "ask for more samples in a region of one part alone");
}

PassDivision common_division(const PassDivision& a, const PassDivision& b) {
  return a == b ? a : PassDivision{};
}

/// From the first pass of either plan to the last pass of either; of parts of one division, to the
/// last one that either was to have.
StopPlan merged_plan(const StopPlan& a, const StopPlan& b, const PassSet& passes) {
  StopPlan plan;
  plan.first_pass = std::min(a.first_pass, b.first_pass);
  plan.division = common_division(a.division, b.division);
  const uint32_t end = plan.division.is_divided()
                           ? std::max(a.first_pass + a.passes, b.first_pass + b.passes)
                           : passes.ranges().back().end;
  plan.passes = end - plan.first_pass;
  return plan;
}

/// A part of a second that sums of times are exact in, in whatever order they are added.
double to_exact_part(double seconds) {
  return std::ldexp(std::round(std::ldexp(seconds, 20)), -20);
}

/// All but the plan, of the part whose passes begin first: so the order of merging makes no
/// difference. Parts that were to write different pictures leave open what the whole is to write.
RenderRecord merged_record(RenderRecord first, const RenderRecord& other) {
  if (first.outputs.files != other.outputs.files) first.outputs.files.clear();
  first.instruction_sets.insert(other.instruction_sets.begin(), other.instruction_sets.end());
  first.seconds = to_exact_part(first.seconds) + to_exact_part(other.seconds);
  return first;
}

uint32_t first_of(const PassSet& passes) { return passes.ranges().front().begin; }

/// All but the film, whose passes are together already; `leads`: the part's began first.
void merge_facts(Checkpoint& whole, const RenderRecord& part, const Lessons& lessons, bool leads) {
  // Of as many passes they may have been written at different times: one order of them for all.
  const auto order = [](const Lessons& l) { return std::tie(l.passes, l.bytes); };
  if (order(whole.lessons) < order(lessons)) whole.lessons = lessons;
  RenderRecord record = merged_record(leads ? part : whole.record, leads ? whole.record : part);
  record.plan = merged_plan(whole.record.plan, part.plan, whole.film.passes());
  whole.record = std::move(record);
}

/// What is wrong with the file whose beginning made no sense: if bytes of it have changed, that.
Error explained(const Error& found, const std::string& path) {
  try {
    const CheckpointReader checked(path);
  } catch (const Error& damaged) {
    return damaged;
  }
  return found;
}

}  // namespace

void merge_checkpoint(Checkpoint& whole, const std::string& whole_path, const Checkpoint& part,
                      const std::string& path) {
  check_same_kind(kind_of(whole.record, whole.film), whole_path, kind_of(part.record, part.film),
                  path);
  check_passes_are_new(whole.film.passes(), part.film.passes(), path);
  check_regions_are_new(whole.film.twice_in_regions(part.film), path);
  const bool leads = first_of(part.film.passes()) < first_of(whole.film.passes());
  whole.film.add(part.film);
  merge_facts(whole, part.record, part.lessons, leads);
}

void merge_checkpoint_file(Checkpoint& whole, const std::string& whole_path,
                           const std::string& path) {
  CheckpointReader part(path);
  const PassSet& passes = part.film_head().passes;
  check_same_kind(kind_of(whole.record, whole.film), whole_path, kind_of(part), path);
  check_passes_are_new(whole.film.passes(), passes, path);
  const bool leads = first_of(passes) < first_of(whole.film.passes());
  check_regions_are_new(part.add_film_to(whole.film), path);
  merge_facts(whole, part.record(), part.lessons(), leads);
}

MergedPasses check_parts(const std::vector<std::string>& paths, const std::string& program) {
  MergedPasses merged;
  std::optional<std::pair<Kind, std::string>> first;
  Problems problems;
  for (const std::string& path : paths) try {
      const CheckpointReader reader(path, FileCheck::frame_only);
      check_program(path, reader.record().program, program);
      const PassDivision& division = reader.record().plan.division;
      if (first) check_same_kind(first->first, first->second, kind_of(reader), path);
      check_passes_are_new(merged.passes, reader.film_head().passes, path);
      merged.passes.add(reader.film_head().passes);
      merged.division = first ? common_division(merged.division, division) : division;
      if (!first) first = {kind_of(reader), path};
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::input) throw;
      const Error cause = explained(error, path);
      for (const Problem& problem : cause.problems())
        problems.add(problem.message, problem.remedy, problem.place);
    }
  problems.throw_if_any();
  return merged;
}

}  // namespace kaustik
