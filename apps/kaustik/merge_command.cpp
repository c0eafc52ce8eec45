#include <fmt/format.h>

#include "commands.h"
#include "failures.h"
#include "file_roles.h"
#include "kaustik/base/version.h"
#include "kaustik/render/checkpoint.h"
#include "kaustik/render/photon_tracing.h"
#include "kaustik/render/program_version.h"
#include "option_values.h"
#include "picture_output.h"
#include "screen.h"

namespace kaustik::app {
namespace {

struct MergeOptions {
  std::vector<std::string> inputs, outputs;
  bool force = false;
};

/// What a merge writes may replace neither its parts nor what somebody else has computed.
void add_output(FileRoles& roles, const std::string& path, const FileKind& kind, bool force) {
  roles.writes(path, kind, force ? Replacing::anything : Replacing::nothing, "choose another name");
}

void merge_photons(const MergeOptions& options, FileRoles& roles) {
  if (options.outputs.size() > 1)
    throw Error(ErrorKind::input, "photon maps are written to one file",
                "give one output: -o MAP.kpm");
  const std::string& output = options.outputs.front();
  add_output(roles, output, {"a photon map", is_photon_file}, options.force);
  std::vector<StoredPhotons> parts;
  for (const std::string& input : options.inputs) parts.push_back(read_photon_file(input));
  const StoredPhotons whole = merged_photons(parts);
  write_photon_file(output, whole);
  say("wrote {}: {} global and {} caustic photons", output, whole.maps.global.size(),
      whole.maps.caustic.size());
}

bool names_checkpoint(const std::string& output) { return output.ends_with(".kpt"); }

/// The outputs that are images.
std::vector<std::string> images_of(const MergeOptions& options) {
  std::vector<std::string> images;
  for (const std::string& output : options.outputs)
    if (!names_checkpoint(output)) images.push_back(output);
  return images;
}

/// One file after the other, so that two films are in memory at most.
Checkpoint merged_checkpoints(const std::vector<std::string>& paths) {
  Checkpoint whole = read_checkpoint(paths.front());
  check_program(paths.front(), whole.record.program, KAUSTIK_VERSION);
  for (size_t i = 1; i < paths.size(); ++i) {
    const Checkpoint part = read_checkpoint(paths[i]);
    check_program(paths[i], part.record.program, KAUSTIK_VERSION);
    merge_checkpoint(whole, paths.front(), part, paths[i]);
  }
  return whole;
}

void merge_passes(const MergeOptions& options, FileRoles& roles) {
  OutputPlan images;
  images.files = images_of(options);
  check_outputs(images, roles);
  for (const std::string& output : options.outputs)
    if (names_checkpoint(output))
      add_output(roles, output, {"a checkpoint", is_checkpoint}, options.force);
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

void merge(const MergeOptions& options) {
  FileRoles roles;
  for (const std::string& input : options.inputs) roles.reads(input, options.force);
  const std::string& first = options.inputs.front();
  if (is_checkpoint(first)) return merge_passes(options, roles);
  if (is_photon_file(first)) return merge_photons(options, roles);
  throw Error(ErrorKind::input, "this is neither a checkpoint nor a photon map",
              "give files that were written by: kaustik render --checkpoint FILE.kpt, or kaustik "
              "photons --part I/N",
              place_in(first));
}

}  // namespace

void add_merge(CLI::App& program) {
  CLI::App* command = program.add_subcommand(
      "merge",
      "Join results computed in parts: passes of a picture (kaustik render --first-pass "
      "--checkpoint), or photon maps (kaustik photons --part).");
  command->footer("The result has the same bits as a single run, whatever the order of the parts.");
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
  command->add_flag("--force", o->force, "Replace an existing checkpoint or photon map");
  command->callback([o] { merge(*o); });
}

}  // namespace kaustik::app
