#include <fmt/format.h>

#include "commands.h"
#include "file_roles.h"
#include "kaustik/base/error.h"
#include "kaustik/image/denoise.h"
#include "kaustik/image/image_io.h"
#include "kaustik/render/finished_picture.h"
#include "option_values.h"
#include "picture_file.h"
#include "screen.h"
#include "standard_streams.h"

namespace kaustik::app {
namespace {

/// What denoising takes beside the image and its result: planes of floats, of all kinds of light.
constexpr int64_t denoiser_bytes_per_pixel = 440;

/// An image, or that of a checkpoint.
Image read_rendered(const std::string& path) {
  if (is_standard_stream(path) || !is_checkpoint(path))
    return read_image_beside(path, denoiser_bytes_per_pixel, 2);
  const Checkpoint checkpoint = read_checkpoint(path);
  RenderRecord record = checkpoint.record;
  record.outputs.denoise = false;
  return finished_picture(checkpoint.film.image(), record, PictureFacts::of(checkpoint.film),
                          {note, warn});
}

/// What is wrong with an image is told with its name.
Image denoised(const std::string& path) {
  const Image image = read_rendered(path);
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
      "denoise", "Smooth the noise of a rendered EXR or checkpoint, by its measured noise.");
  command->footer(
      "Edges of surfaces stay. Details of the illumination fainter than its noise are lost.\n"
      "From two passes on, the layer denoised_error holds the error of the result.");
  struct Options {
    std::string input, output;
    bool full_float = false, force = false;
  };
  auto o = std::make_shared<Options>();
  takes_files(command
                  ->add_option("image", o->input,
                               "EXR that kaustik rendered, with all its layers, or a checkpoint")
                  ->required(),
              {"exr", "kpt"});
  takes_files(command
                  ->add_option("-o,--output", o->output,
                               "EXR, HDR, PFM or LogLuv tif to write; - for standard output. For "
                               "displays use kaustik tonemap")
                  ->required(),
              {"exr", "hdr", "pfm", "tif"});
  command->add_flag("--float", o->full_float, "EXR with 32-bit instead of 16-bit floats");
  command->add_flag("--force", o->force, "Replace the input image");
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
