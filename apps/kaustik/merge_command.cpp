#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>

#include "commands.h"
#include "failures.h"
#include "kaustik/render/checkpoint.h"
#include "kaustik/render/photon_tracing.h"
#include "kaustik/scene/file_stamp.h"
#include "merge_options.h"
#include "option_values.h"
#include "progress_options.h"
#include "screen.h"

namespace kaustik::app {

void add_merged_output(FileRoles& roles, const std::string& path, const FileKind& kind,
                       bool force) {
  roles.writes(path, kind, force ? Replacing::anything : Replacing::nothing, "choose another name");
}

namespace {

void merge_photons(const MergeOptions& options, FileRoles& roles) {
  if (options.outputs.size() > 1)
    throw Error(ErrorKind::input, "photon maps are written to one file",
                "give one output: -o MAP.kpm");
  const std::string& output = options.outputs.front();
  add_merged_output(roles, output, {"a photon map", is_photon_file}, options.force);
  std::vector<StoredPhotons> parts;
  for (const std::string& input : options.inputs) parts.push_back(read_photon_file(input));
  ProgressDisplay progress(progress_style({}));
  const auto begin = std::chrono::steady_clock::now();
  const PhotonCounts counts = write_merged_photons(output, parts, [&](double share) {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
    progress.show(share, elapsed.count());
  });
  progress.finish();
  say("wrote {}: {} global and {} caustic photons", output, counts[0], counts[1]);
}

/// Whether all that the parts hold is in it: images have neither passes nor photons.
bool holds_all(const std::string& output) {
  return output.ends_with(".kpt") || output.ends_with(".kpm");
}

void check_consumption(const MergeOptions& options) {
  if (options.consume && std::ranges::none_of(options.outputs, holds_all))
    throw Error(ErrorKind::input, "nothing that is written holds what the parts hold",
                "write a checkpoint (-o FILE.kpt) or a photon map (-o FILE.kpm) as well",
                place_in("command line: --consume"));
}

/// A part, and what the system told of its file before it was read.
struct Part {
  std::string path;
  std::optional<FileStamp> stamp;
};

std::vector<Part> parts_of(const MergeOptions& options) {
  std::vector<Part> parts;
  for (const std::string& input : options.inputs) parts.push_back({input, stamp_of_file(input)});
  return parts;
}

/// What a task has put in its place since then is in no output.
void remove_part(const Part& part) {
  if (stamp_of_file(part.path) != part.stamp)
    throw Error(ErrorKind::input, "it was written anew while it was merged, and stays",
                "see whether a task still renders it, then remove it", place_in(part.path));
  std::filesystem::remove(part.path);
}

/// All but those that an output has replaced.
void remove_parts(const std::vector<Part>& parts, const std::vector<std::string>& outputs) {
  Failures failures;
  size_t count = 0;
  for (const Part& part : parts) {
    const auto is_it = [&](const std::string& output) { return is_same_file(part.path, output); };
    if (std::ranges::any_of(outputs, is_it)) continue;
    failures.attempt_to(fmt::format("remove '{}'", part.path), [&] {
      remove_part(part);
      ++count;
    });
  }
  if (count > 0)
    say("removed {} part{}: what they held is in {}", count, count == 1 ? "" : "s",
        *std::ranges::find_if(outputs, holds_all));
  failures.throw_if_any();
}

void merge(const MergeOptions& options) {
  check_consumption(options);
  FileRoles roles;
  for (const std::string& input : options.inputs) roles.reads(input, options.force);
  const std::vector<Part> parts = parts_of(options);
  const std::string& first = options.inputs.front();
  if (is_checkpoint(first))
    merge_passes(options, roles);
  else if (is_photon_file(first))
    merge_photons(options, roles);
  else
    throw Error(ErrorKind::input, "this is neither a checkpoint nor a photon map",
                "give files that were written by: kaustik render --checkpoint FILE.kpt, or kaustik "
                "photons --part I/N",
                place_in(first));
  if (options.consume) remove_parts(parts, options.outputs);
}

}  // namespace

void add_merge(CLI::App& program) {
  CLI::App* command = program.add_subcommand(
      "merge",
      "Join results computed in parts: passes of a picture (kaustik render --part), or photon maps "
      "(kaustik photons --part).");
  command->footer(
      "The result has the same bits as a single run, whatever the order of the parts: of a photon "
      "map, all but the sum of flux in its report. A checkpoint of some parts can be merged with "
      "others. Passes need the memory of one film, however many "
      "parts there are; photons some hundred MB, and twice their room on the disk meanwhile. If a "
      "part is damaged, given twice, or of another render, nothing is written and nothing is "
      "removed.");
  auto o = std::make_shared<MergeOptions>();
  takes_files(command
                  ->add_option("parts", o->inputs,
                               "Checkpoints (.kpt) of different passes, or photon maps (.kpm), all "
                               "parts of one pass")
                  ->required(),
              {"kpt", "kpm"});
  takes_files(command
                  ->add_option("-o,--output", o->outputs,
                               "Image or checkpoint (.kpt) to write, may be repeated; for photon "
                               "maps a photon map (.kpm)")
                  ->take_all()
                  ->allow_extra_args(false)
                  ->required(),
              {"kpt", "kpm", "exr", "hdr", "pfm", "tif", "png", "jpg", "ppm"});
  command->add_flag("--incomplete", o->incomplete,
                    "Make the picture of the given parts, even if others are missing");
  command->add_flag("--consume", o->consume,
                    "Remove the parts once the checkpoint or photon map of them is written");
  command->add_flag("--force", o->force, "Replace an existing checkpoint or photon map");
  command->callback([o] { merge(*o); });
}

}  // namespace kaustik::app
