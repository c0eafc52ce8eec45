#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>

#include "failures.h"
#include "kaustik/base/version.h"
#include "kaustik/render/checkpoint_merge.h"
#include "kaustik/render/program_version.h"
#include "merge_options.h"
#include "picture_output.h"
#include "screen.h"

namespace kaustik::app {
namespace {

bool names_checkpoint(const std::string& output) { return output.ends_with(".kpt"); }

/// The outputs that are images.
std::vector<std::string> images_of(const MergeOptions& options) {
  std::vector<std::string> images;
  std::ranges::copy_if(options.outputs, std::back_inserter(images),
                       [](const std::string& output) { return !names_checkpoint(output); });
  return images;
}

/// A picture of some parts may be taken for the whole; a checkpoint of some may be merged further.
void tell_of_missing_parts(const MergedPasses& merged, bool makes_images, bool may_be_incomplete) {
  const MissingParts missing = missing_parts(merged.division, merged.passes);
  if (missing.empty()) return;
  const std::string text = missing.text(merged.division.parts);
  if (makes_images && !may_be_incomplete)
    throw Error(ErrorKind::input, text,
                "render them: kaustik render --part I/N; or make the picture of what is there: "
                "--incomplete");
  if (makes_images)
    warn(text + ": the picture is of the others");
  else
    note(text);
}

/// Who removes a part takes from its task what it would go on with: the same passes would come
/// again.
void check_consumed_parts(const MergedPasses& merged) {
  const MissingParts missing = missing_parts(merged.division, merged.passes);
  if (missing.unfinished.empty()) return;
  throw Error(ErrorKind::input, MissingParts{{}, missing.unfinished}.text(merged.division.parts),
              "finish them first, by their command or kaustik resume; or keep all parts: leave out "
              "--consume",
              place_in("command line: --consume"));
}

/// Of one file after the other, so that one film is in memory. Those that can't be read are told
/// together.
Checkpoint merged_checkpoints(const std::vector<std::string>& paths) {
  std::optional<Checkpoint> whole;
  Problems problems;
  for (const std::string& path : paths) try {
      if (!problems.empty())
        const CheckpointReader checked(path);
      else if (!whole)
        whole = read_checkpoint(path);
      else
        merge_checkpoint_file(*whole, paths.front(), path);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::input) throw;
      for (const Problem& problem : error.problems())
        problems.add(problem.message, problem.remedy, problem.place);
    }
  problems.throw_if_any();
  return std::move(*whole);
}

}  // namespace

void merge_passes(const MergeOptions& options, FileRoles& roles) {
  OutputPlan images;
  images.files = images_of(options);
  refuse_tables(images);
  check_outputs(images, roles);
  for (const std::string& output : options.outputs)
    if (names_checkpoint(output))
      add_merged_output(roles, output, {"a checkpoint", is_checkpoint}, options.force);
  const MergedPasses merged = check_parts(options.inputs, KAUSTIK_VERSION);
  if (options.consume) check_consumed_parts(merged);
  tell_of_missing_parts(merged, !images.files.empty(), options.incomplete);
  Checkpoint whole = merged_checkpoints(options.inputs);
  // What is written here is what resume is to write later.
  if (!images.files.empty()) whole.record.outputs.files = images.files;
  Failures failures;
  for (const std::string& output : options.outputs)
    if (names_checkpoint(output))
      failures.attempt(output, [&] {
        write_checkpoint(output, whole.record, whole.film, whole.lessons);
        say("wrote {}: passes {}", output, whole.film.passes().text());
      });
  whole.record.outputs.files = images.files;
  write_pictures(whole.film, whole.record, {PictureFacts::of(whole.film)}, failures,
                 PictureState::finished);
  print_errors(whole.film);
  failures.throw_if_any();
}

}  // namespace kaustik::app
