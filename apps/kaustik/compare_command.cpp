#include <fmt/format.h>

#include "commands.h"
#include "file_roles.h"
#include "kaustik/base/error.h"
#include "kaustik/image/image_io.h"
#include "kaustik/image/metrics.h"
#include "numbers.h"
#include "option_values.h"
#include "standard_streams.h"

namespace kaustik::app {
namespace {

struct CompareOptions {
  std::string image, reference, difference, layer;
  double scale = 1;
};

void compare(const CompareOptions& options) {
  FileRoles roles;
  roles.reads(options.image);
  roles.reads(options.reference);
  if (!options.difference.empty()) {
    if (is_standard_stream(options.difference))
      throw Error(ErrorKind::input, "standard output is for the figures, not for the picture",
                  "give the name of a file: -o FILE.png");
    check_writable(options.difference);
    roles.writes(options.difference);
  }
  // What comparing takes beside the two images, measured on 16 million pixels.
  constexpr int64_t compared_bytes_per_pixel = 12;
  Image given = read_image_beside(options.image, compared_bytes_per_pixel, 2);
  const auto [image, reference] = same_pixels(
      std::move(given), read_image_beside(options.reference, compared_bytes_per_pixel, 2));
  const ImageComparison c = compare_images(image, reference, options.layer);
  fmt::print("mse                  {:.6g}\n", c.mse);
  fmt::print("relative_mse         {:.6g}\n", c.relative_mse);
  fmt::print("relative_mse_trimmed {:.6g}   (without the worst 0.1 % of the pixels)\n",
             c.relative_mse_trimmed);
  if (options.layer.empty() && reference.find_channel("error.R") >= 0)
    fmt::print(
        "reference_noise      {:.6g}   (what the reference's own noise adds to the trimmed)\n",
        own_relative_mse(reference));
  fmt::print("mean_ratio           {:.6f} {:.6f} {:.6f}\n", c.mean_ratio.x, c.mean_ratio.y,
             c.mean_ratio.z);
  if (c.non_finite_pixels > 0) fmt::print("non_finite_pixels    {}\n", c.non_finite_pixels);
  if (options.difference.empty()) return;
  WriteOptions write;
  write.tone = make_tone_operator("srgb");
  write_image(difference_image(image, reference, float(options.scale), options.layer),
              options.difference, write);
}

}  // namespace

void add_compare(CLI::App& program) {
  CLI::App* command = program.add_subcommand(
      "compare", "Compare an image with a reference and print the differences.");
  auto o = std::make_shared<CompareOptions>();
  takes_files(command->add_option("image", o->image, "Image to judge")->required(),
              picture_extensions());
  takes_files(command->add_option("reference", o->reference, "Reference image")->required(),
              picture_extensions());
  takes_files(command->add_option(
                  "-o,--output", o->difference,
                  "Write a picture of the relative difference: red is brighter, blue darker"),
              written_extensions());
  command->add_option("--scale", o->scale, "Relative difference shown as full red or blue [1]")
      ->check(number_between(0, std::numeric_limits<double>::infinity()));
  takes(command->add_option("--layer", o->layer, "Layer to compare [the picture itself]"), "LAYER");
  command->callback([o] { compare(*o); });
}

}  // namespace kaustik::app
