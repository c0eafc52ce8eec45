#include <fmt/format.h>

#include "commands.h"
#include "failures.h"
#include "file_roles.h"
#include "kaustik/image/stitch.h"
#include "option_values.h"
#include "picture_file.h"
#include "screen.h"

namespace kaustik::app {
namespace {

struct StitchOptions {
  std::vector<std::string> parts, outputs;
  bool full_float = false, force = false;
};

void stitch(const StitchOptions& options) {
  FileRoles roles;
  for (const std::string& part : options.parts) roles.reads(part, options.force);
  for (const std::string& output : options.outputs) {
    check_picture_writable(output);
    roles.writes(output);
  }
  Stitcher stitcher;
  for (const std::string& part : options.parts) stitcher.add(part, read_image_beside(part, 0, 2));
  for (const std::string& key : stitcher.differing())
    warn(fmt::format("the parts do not agree on '{}', which is left out", key));
  const Image whole = std::move(stitcher).finish();
  WriteOptions write;
  write.exr_half = !options.full_float;
  Failures failures;
  for (const std::string& output : options.outputs)
    failures.attempt(output, [&] {
      write_picture(whole, output, write);
      say("wrote {}: {} × {} pixels", picture_name(output), whole.width(), whole.height());
    });
  failures.throw_if_any();
}

}  // namespace

void add_stitch(CLI::App& program) {
  CLI::App* command = program.add_subcommand("stitch", "Join EXR files of parts into one picture.");
  command->footer(
      "Render the parts with the film's crop window: kaustik render SCENE --set "
      "film.crop_offset_y=0 --set film.crop_height=540 -o top.exr\n"
      "The parts must cover the picture. Where they overlap, they must be equal.");
  auto o = std::make_shared<StitchOptions>();
  takes_files(
      command->add_option("parts", o->parts, "EXR files; their data windows give their places")
          ->required(),
      {"exr"});
  takes_files(command
                  ->add_option("-o,--output", o->outputs,
                               "Image to write, in a format of kaustik render; may be repeated")
                  ->take_all()
                  ->allow_extra_args(false)
                  ->required(),
              written_extensions());
  command->add_flag("--float", o->full_float, "EXR with 32-bit instead of 16-bit floats");
  command->add_flag("--force", o->force, "Replace an input image");
  command->callback([o] { stitch(*o); });
}

}  // namespace kaustik::app
