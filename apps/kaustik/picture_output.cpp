#include "picture_output.h"

#include <fmt/format.h>

#include <new>

#include "console.h"
#include "kaustik/base/parallel.h"
#include "kaustik/image/denoise.h"
#include "kaustik/image/image_io.h"

namespace kaustik::app {
namespace {

void set_metadata(Image& image, const Film& film, const RenderRecord& record,
                  const OutputOptions& options) {
  image.set_metadata("software", "Kaustik " + record.program);
  image.set_metadata("scene", record.recipe.scene);
  image.set_metadata("integrator", record.view.integrator);
  image.set_metadata("seed", int64_t(record.recipe.seed));
  image.set_metadata("passes", int64_t(film.pass_count()));
  image.set_metadata("samples_per_pixel",
                     int64_t(film.pass_count()) * record.recipe.samples_per_pass);
  image.set_metadata("horizontal_fov", record.view.horizontal_fov);
  image.set_metadata("vertical_fov", record.view.vertical_fov);
  image.set_metadata(
      "quantity",
      std::string(record.view.quantity == Quantity::irradiance ? "irradiance" : "radiance"));
  if (options.incomplete_pass) image.set_metadata("incomplete", std::string("cancelled in pass 1"));
  if (!record.outputs.reproducible) image.set_metadata("render_seconds", record.seconds);
}

/// The picture is worth more than its smoothing: where that fails the picture stays.
void smooth_noise(Image& image) {
  if (!can_denoise(image)) {
    warn("the picture has no component with noise, or no surfaces: --denoise did nothing");
    return;
  }
  try {
    image = denoise(image);
  } catch (const std::bad_alloc&) {
    warn("not enough memory to denoise: the picture is written as it was rendered");
  }
}

}  // namespace

void check_outputs(const OutputPlan& outputs) {
  for (const std::string& file : outputs.files) check_writable(file);
  make_tone_operator(outputs.tone, outputs.tone_settings);
}

void write_pictures(const Film& film, const RenderRecord& record, const OutputOptions& options) {
  WriteOptions write;
  write.exr_half = !record.outputs.full_float;
  write.tone = make_tone_operator(record.outputs.tone, record.outputs.tone_settings);
  Image image = film.image();
  set_metadata(image, film, record, options);
  if (record.outputs.denoise) with_threads(options.threads, [&] { smooth_noise(image); });
  for (const std::string& file : record.outputs.files) {
    write_image(image, file, write);
    if (!options.quiet) fmt::print(stderr, "wrote {}\n", file);
  }
}

void print_errors(const Film& film) {
  const double of_mean = film.mean_error(), of_pixels = film.picture_error();
  if (std::isfinite(of_mean))
    fmt::print(stderr, "mean of the picture: ±{:.2g} % (95 % confidence, {} passes)\n",
               100 * of_mean, film.pass_count());
  if (std::isfinite(of_pixels))
    fmt::print(stderr, "error of the pixels: {:.2g} % (standard error, root mean square)\n",
               100 * of_pixels);
}

}  // namespace kaustik::app
