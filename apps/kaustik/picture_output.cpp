#include "picture_output.h"

#include <fmt/format.h>

#include <cmath>
#include <new>

#include "console.h"
#include "kaustik/base/parallel.h"
#include "kaustik/image/denoise.h"
#include "picture_file.h"
#include "standard_streams.h"

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
                     int64_t(film.samples_per_pixel()) +
                         std::llround(options.part * record.recipe.samples_per_pass));
  image.set_metadata("horizontal_fov", record.view.horizontal_fov);
  image.set_metadata("vertical_fov", record.view.vertical_fov);
  image.set_metadata(
      "quantity",
      std::string(record.view.quantity == Quantity::irradiance ? "irradiance" : "radiance"));
  if (const PictureFrame& f = image.frame(); !image.is_whole())
    image.set_metadata(crop_window_key,
                       fmt::format("{} x {} pixels at ({}, {}) of {} x {}", image.width(),
                                   image.height(), f.x, f.y, f.width, f.height));
  if (options.incomplete_pass)
    image.set_metadata("incomplete", std::string("ended within the first pass"));
  if (!record.outputs.reproducible) image.set_metadata("render_seconds", record.seconds);
}

/// The picture is worth more than its smoothing: where that fails the picture stays.
void smooth_noise(Image& image, int threads) {
  try {
    if (can_denoise(image))
      with_threads(threads, [&] { image = denoise(image); });
    else
      warn("the picture has no component with noise, or no surfaces: --denoise did nothing");
  } catch (const std::exception& error) {
    const bool lacks_memory = dynamic_cast<const std::bad_alloc*>(&error) != nullptr;
    warn(fmt::format("cannot denoise, so the picture is written as it was rendered: {}",
                     lacks_memory ? "not enough memory" : error.what()));
  }
}

}  // namespace

void check_outputs(const OutputPlan& outputs, FileRoles& roles) {
  for (const std::string& file : outputs.files) {
    check_picture_writable(file);
    roles.writes(file);
  }
  make_tone_operator(outputs.tone, outputs.tone_settings);
}

void write_pictures(const Film& film, const RenderRecord& record, const OutputOptions& options,
                    Failures& failures, const std::function<Image()>& picture) {
  WriteOptions write;
  write.exr_half = !record.outputs.full_float;
  Image image;
  bool is_made = false;
  failures.attempt_to("make the picture", [&] {
    write.tone = make_tone_operator(record.outputs.tone, record.outputs.tone_settings);
    image = picture ? picture() : film.image();
    if (record.view.frame.width > 0) image.set_frame(record.view.frame);
    set_metadata(image, film, record, options);
    if (record.outputs.denoise) smooth_noise(image, options.threads);
    is_made = true;
  });
  if (!is_made) return;
  for (const std::string& file : record.outputs.files)
    failures.attempt(file, [&] {
      write_picture(image, file, write);
      if (!options.quiet) say("wrote {}", picture_name(file));
    });
}

void print_errors(const Film& film) {
  const double of_mean = film.mean_error(), of_pixels = film.picture_error();
  if (std::isfinite(of_mean))
    say("mean of the picture: ±{:.2g} % (95 % confidence, {} passes)", 100 * of_mean,
        film.pass_count());
  if (std::isfinite(of_pixels))
    say("error of the pixels: {:.2g} % (standard error, root mean square)", 100 * of_pixels);
}

}  // namespace kaustik::app
