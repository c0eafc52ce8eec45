#include "kaustik/render/finished_picture.h"

#include <fmt/format.h>

#include <cmath>
#include <new>

#include "kaustik/base/parallel.h"
#include "kaustik/image/denoise.h"
#include "kaustik/render/part_picture.h"

namespace kaustik {
namespace {

void set_metadata(Image& image, const RenderRecord& record, const PictureFacts& facts) {
  image.set_metadata("software", "Kaustik " + record.program);
  image.set_metadata("scene", record.recipe.scene);
  image.set_metadata("integrator", record.view.integrator);
  image.set_metadata("seed", int64_t(record.recipe.seed));
  image.set_metadata("passes", int64_t(facts.passes));
  image.set_metadata(
      "samples_per_pixel",
      int64_t(facts.samples_per_pixel) + std::llround(facts.part * record.recipe.samples_per_pass));
  if (record.view.horizontal_fov > 0) {
    image.set_metadata("horizontal_fov", record.view.horizontal_fov);
    image.set_metadata("vertical_fov", record.view.vertical_fov);
  }
  image.set_metadata(
      "quantity",
      std::string(record.view.quantity == Quantity::irradiance ? "irradiance" : "radiance"));
  if (record.view.exposure != 0) image.set_metadata(film_exposure_key, record.view.exposure);
  if (const PictureFrame& f = image.frame(); !image.is_whole())
    image.set_metadata(crop_window_key,
                       fmt::format("{} x {} pixels at ({}, {}) of {} x {}", image.width(),
                                   image.height(), f.x, f.y, f.width, f.height));
  if (facts.incomplete_pass)
    image.set_metadata(incomplete_key, std::string("ended within the first pass"));
  if (record.instruction_sets.size() > 1)
    image.set_metadata("instruction_sets",
                       fmt::format("{}", fmt::join(record.instruction_sets, ", ")));
  if (!record.outputs.reproducible) image.set_metadata("render_seconds", record.seconds);
}

/// The picture is worth more than its smoothing: where that fails the picture stays.
void smooth_noise(Image& image, int threads, const Messages& messages) {
  try {
    if (can_denoise(image))
      with_threads(threads, [&] { image = denoise(image); });
    else
      messages.warn("the picture has no component with noise, or no surfaces: it is not denoised");
  } catch (const std::exception& error) {
    const bool lacks_memory = dynamic_cast<const std::bad_alloc*>(&error) != nullptr;
    messages.warn(fmt::format("cannot denoise, so the picture is written as it was rendered: {}",
                              lacks_memory ? "not enough memory" : error.what()));
  }
}

}  // namespace

Image finished_picture(Image image, const RenderRecord& record, const PictureFacts& facts,
                       const Messages& messages) {
  if (record.view.frame.width > 0) image.set_frame(record.view.frame);
  set_metadata(image, record, facts);
  if (record.outputs.denoise && !image.find_metadata("denoised"))
    smooth_noise(image, facts.threads, messages);
  return image;
}

}  // namespace kaustik
