#include <fmt/format.h>

#include "commands.h"
#include "kaustik/base/error.h"
#include "kaustik/image/image_io.h"

namespace kaustik::app {
namespace {

struct TonemapOptions {
  std::string input, output, layer, tone = "histogram";
  float exposure = 0, fov = 0, display_maximum = 100, display_range = 100;
};

void tonemap(const TonemapOptions& options) {
  check_writable(options.output);
  const Image image = read_image(options.input);
  WriteOptions write;
  ToneMapping& mapping = write.tone_mapping;
  mapping.op = tone_operator_from_name(options.tone);
  mapping.exposure = options.exposure;
  mapping.display_max_luminance = options.display_maximum;
  mapping.display_dynamic_range = options.display_range;
  const auto read_fov = [&](const char* key, float& fov) {
    if (const MetadataValue* value = image.find_metadata(key))
      if (const double* degrees = std::get_if<double>(value)) fov = float(*degrees);
  };
  read_fov("horizontal_fov", mapping.horizontal_fov);
  read_fov("vertical_fov", mapping.vertical_fov);
  if (options.fov > 0) {
    mapping.horizontal_fov = options.fov;
    mapping.vertical_fov = 0;
  }
  write.layer = options.layer;
  write_image(image, options.output, write);
}

}  // namespace

void add_tonemap(CLI::App& program) {
  CLI::App* command = program.add_subcommand(
      "tonemap",
      "Turn a high dynamic range image (exr, hdr, pfm, LogLuv tif) into one for displays.");
  auto o = std::make_shared<TonemapOptions>();
  command->add_option("input", o->input, "Image to read")->required();
  command->add_option("-o,--output", o->output, "png, jpg or ppm to write")->required();
  command->add_option("--operator", o->tone, "histogram, linear or srgb [histogram]");
  command->add_option("--layer", o->layer, "Layer of an EXR, such as caustic [the picture itself]");
  command->add_option("--exposure", o->exposure, "Stops, for --operator linear [0]");
  command->add_option("--fov", o->fov, "Horizontal field of view, degrees [from the file, else 50]")
      ->check(CLI::Range(0.001, 179.9));
  command->add_option("--display-maximum", o->display_maximum, "Display white, cd/m² [100]")
      ->check(CLI::PositiveNumber);
  command->add_option("--display-range", o->display_range, "Display white over black [100]")
      ->check(CLI::Range(1.01, 1e9));
  command->callback([o] { tonemap(*o); });
}

}  // namespace kaustik::app
