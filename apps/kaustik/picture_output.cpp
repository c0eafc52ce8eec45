#include "picture_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "console.h"
#include "picture_file.h"
#include "standard_streams.h"

namespace kaustik::app {
void check_outputs(const OutputPlan& outputs, FileRoles& roles) {
  for (const std::string& file : outputs.files) {
    check_picture_writable(file);
    roles.writes(file);
  }
  make_tone_operator(outputs.tone, outputs.tone_settings);
}

bool needs_layers(const OutputPlan& outputs) {
  return outputs.denoise ||
         std::any_of(outputs.files.begin(), outputs.files.end(), picture_holds_layers);
}

void write_pictures(const Film& film, const RenderRecord& record, const OutputOptions& options,
                    Failures& failures, const std::function<Image()>& picture) {
  WriteOptions write;
  write.exr_half = !record.outputs.full_float;
  Image image;
  bool is_made = false;
  failures.attempt_to("make the picture", [&] {
    write.tone = make_tone_operator(record.outputs.tone, record.outputs.tone_settings);
    image = finished_picture(picture ? picture() : film.image(), film, record, options.facts,
                             {note, warn});
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
