#include <fmt/format.h>

#include "commands.h"
#include "file_roles.h"
#include "kaustik/base/error.h"
#include "kaustik/image/denoise.h"
#include "kaustik/image/image_io.h"
#include "option_values.h"
#include "picture_file.h"

namespace kaustik::app {
namespace {

/// What denoising takes beside the image and its result, measured on 16 million pixels.
constexpr int64_t denoiser_bytes_per_pixel = 4;

/// What is wrong with an image is told with its name.
Image denoised(const std::string& path) {
  const Image image = read_image_beside(path, denoiser_bytes_per_pixel, 2);
  try {
    return denoise(image);
  } catch (const Error& error) {
    const Problem& problem = error.problems().front();
    throw Error(error.kind(), fmt::format("cannot denoise '{}': {}", path, problem.message),
                problem.remedy);
  }
}

}  // namespace

void add_denoise(CLI::App& program) {
  CLI::App* command = program.add_subcommand(
      "denoise", "Smooth the noise of a rendered EXR, by what its layers know of the surfaces.");
  command->footer(
      "Edges of what is seen stay; details of the light that are fainter than its noise are lost,\n"
      "so the result is for looking at, not for measuring.");
  struct Options {
    std::string input, output;
    bool full_float = false, force = false;
  };
  auto o = std::make_shared<Options>();
  takes_files(
      command->add_option("image", o->input, "EXR that kaustik rendered, with all its layers")
          ->required(),
      {"exr"});
  takes_files(command
                  ->add_option("-o,--output", o->output,
                               "EXR, HDR, PFM or LogLuv tif to write, - for standard output; for "
                               "displays: kaustik tonemap")
                  ->required(),
              {"exr", "hdr", "pfm", "tif"});
  command->add_flag("--float", o->full_float, "EXR with 32-bit instead of 16-bit floats");
  command->add_flag("--force", o->force, "Replace the image that is read");
  command->callback([o] {
    FileRoles roles;
    roles.reads(o->input, o->force);
    check_picture_writable(o->output);
    roles.writes(o->output);
    WriteOptions write;
    write.exr_half = !o->full_float;
    write_picture(denoised(o->input), o->output, write);
  });
}

}  // namespace kaustik::app
