#include "picture_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

#include "events.h"
#include "kaustik/base/file.h"
#include "kaustik/render/part_picture.h"
#include "meter_table.h"
#include "picture_file.h"
#include "screen.h"
#include "standard_streams.h"

namespace kaustik::app {

void check_outputs(const OutputPlan& outputs, FileRoles& roles) {
  for (const std::string& file : outputs.files) {
    if (is_table(file))
      check_output_path(file);
    else
      check_picture_writable(file);
    roles.writes(file);
  }
  make_tone_operator(outputs.tone, outputs.tone_settings);
}

void refuse_tables(const OutputPlan& outputs) {
  for (const std::string& file : outputs.files)
    if (is_table(file))
      throw Error(ErrorKind::input,
                  fmt::format("the table '{}' needs the scene, which is not read here", file),
                  fmt::format("write a checkpoint, then: kaustik resume FILE.kpt -o {}", file));
}

bool needs_layers(const OutputPlan& outputs) {
  return outputs.denoise ||
         std::any_of(outputs.files.begin(), outputs.files.end(), picture_holds_layers);
}

namespace {

WriteOptions write_options(const OutputPlan& outputs) {
  WriteOptions write;
  write.exr_half = !outputs.full_float;
  write.tone = make_tone_operator(outputs.tone, outputs.tone_settings);
  return write;
}

std::string state_name(PictureState state) {
  return state == PictureState::finished      ? "finished"
         : state == PictureState::ended_early ? "ended early"
                                              : "so far";
}

/// What events tell of a picture, from its metadata.
JsonObject picture_facts(const Image& image, PictureState state) {
  JsonObject facts;
  facts.add("state", state_name(state));
  for (const char* key : {"passes", "samples_per_pixel"})
    if (const MetadataValue* value = image.find_metadata(key))
      facts.add(key, std::get<int64_t>(*value));
  if (const MetadataValue* value = image.find_metadata(incomplete_key))
    facts.add("incomplete", std::get<std::string>(*value));
  facts.add("width", image.width()).add("height", image.height());
  return facts;
}

/// What the film's meter shows, as far as it is known.
void write_measurements(const Film& film, const Scene& scene, const std::string& file) {
  if (film.pass_count() == 0)
    throw Error(ErrorKind::input,
                fmt::format("the table '{}' is not written: no pass was finished", file),
                "render longer (--time, --passes)");
  write_table(measurements(scene, film), scene.camera().traits().meter_unit, file);
}

}  // namespace

void write_pictures(const Film& film, const RenderRecord& record, const OutputOptions& options,
                    Failures& failures, PictureState state, const std::function<Image()>& picture) {
  if (record.outputs.files.empty()) return;
  WriteOptions write;
  Image image;
  bool is_made = false;
  failures.attempt_to("make the picture", [&] {
    write = write_options(record.outputs);
    if (std::ranges::all_of(record.outputs.files, is_table)) return;
    image =
        finished_picture(picture ? picture() : film.image(), record, options.facts, {note, warn});
    is_made = true;
  });
  for (const std::string& file : record.outputs.files) {
    if (!is_made && !is_table(file)) continue;
    failures.attempt(file, [&] {
      if (is_table(file)) {
        write_measurements(film, *options.scene, file);
        events().written(file, JsonObject().add("state", state_name(state)));
      } else {
        write_picture(image, file, write);
        events().written(picture_name(file), picture_facts(image, state));
      }
      if (!options.quiet) say("wrote {}", picture_name(file));
    });
  }
}

bool write_snapshot(const Job& job, const OutputPlan& outputs) {
  const std::optional<Image> image = job.finished_snapshot({note, warn});
  if (!image) return false;
  const WriteOptions write = write_options(outputs);
  for (const std::string& file : outputs.files) {
    if (is_standard_stream(file) || is_table(file)) {
      note(fmt::format("{} is written at the end only", picture_name(file)));
      continue;
    }
    try {
      write_picture(*image, file, write);
      const JsonObject facts = picture_facts(*image, PictureState::so_far);
      events().written(file, facts);
      note(fmt::format("wrote {} as it is now; the render goes on", file));
    } catch (const std::exception& error) {
      warn(fmt::format("cannot write '{}' as it is now: {}", file, error.what()));
    }
  }
  return true;
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
