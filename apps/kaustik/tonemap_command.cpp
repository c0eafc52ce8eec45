#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "commands.h"
#include "failures.h"
#include "file_roles.h"
#include "kaustik/base/error.h"
#include "kaustik/image/image_io.h"
#include "numbers.h"
#include "option_values.h"
#include "picture_file.h"
#include "screen.h"
#include "standard_streams.h"

namespace kaustik::app {
namespace {

struct TonemapOptions {
  std::vector<std::string> inputs, outputs, settings;
  std::string layer, tone = "histogram";
  std::optional<double> exposure, fov, display_maximum, display_range;
  int quality = 95;
  bool data_window = false, display_window = false, quiet = false, force = false;
};

/// What is to be written of each input: one input may have several outputs; several inputs have as
/// many outputs, or one folder, in which each keeps its name.
std::vector<std::vector<std::string>> outputs_of(const TonemapOptions& options) {
  namespace fs = std::filesystem;
  const auto inside = [](const std::string& folder, const std::string& input) {
    return (fs::path(folder) / fs::path(input).stem()).string() + ".png";
  };
  const auto is_folder = [](const std::string& output) {
    return !is_standard_stream(output) && fs::is_directory(output);
  };
  std::vector<std::vector<std::string>> result(options.inputs.size());
  if (options.inputs.size() == 1) {
    for (const std::string& output : options.outputs)
      result[0].push_back(is_folder(output) ? inside(output, options.inputs[0]) : output);
    return result;
  }
  const bool has_folder = options.outputs.size() == 1 && is_folder(options.outputs[0]);
  if (!has_folder && options.outputs.size() != options.inputs.size())
    throw Error(ErrorKind::input,
                fmt::format("{} images to read, but {} to write", options.inputs.size(),
                            options.outputs.size()),
                "give as many -o as images, or -o with an existing folder");
  for (size_t i = 0; i < options.inputs.size(); ++i)
    result[i].push_back(has_folder ? inside(options.outputs[0], options.inputs[i])
                                   : options.outputs[i]);
  return result;
}

void check_outputs(const TonemapOptions& options,
                   const std::vector<std::vector<std::string>>& outputs) {
  FileRoles roles;
  for (const std::string& input : options.inputs) roles.reads(input, options.force);
  for (const auto& list : outputs)
    for (const std::string& output : list) {
      check_shown_picture_writable(output);
      roles.writes(output);
    }
}

std::shared_ptr<const ToneOperator> operator_of(const TonemapOptions& options) {
  std::vector<std::string> settings = options.settings;
  const auto add = [&](const char* name, const std::optional<double>& value) {
    if (value) settings.push_back(fmt::format("{}={}", name, *value));
  };
  add("exposure", options.exposure);
  add("display_maximum", options.display_maximum);
  add("display_range", options.display_range);
  return make_tone_operator(options.tone, settings);
}

void warn_of_bad_pixels(const std::string& input, const BadPixels& bad) {
  const auto tell = [&](size_t count, const char* what) {
    if (count > 0)
      warn(fmt::format("{}: {} pixel{} {}", input, count, count == 1 ? "" : "s", what));
  };
  tell(bad.not_a_number, "not a number: shown black");
  tell(bad.infinite, "infinite: shown white, or black if negative");
  tell(bad.negative, "of negative luminance: shown black");
}

/// What tone mapping takes beside the image: most by falsecolor, measured on 16 million pixels.
constexpr int64_t tone_bytes_per_pixel = 56;

/// An input as the display shows it; tells what is odd about it.
Image shown(const TonemapOptions& options, const std::string& input, const ToneOperator& tone) {
  Image image = read_image_beside(input, tone_bytes_per_pixel);
  // Beyond a crop window nothing is known, but other pictures are black where they have no pixels.
  const bool is_crop = image.find_metadata(crop_window_key) != nullptr;
  const bool in_frame = options.display_window || (!options.data_window && !is_crop);
  if (!in_frame || has_visible_part(image)) image = visible_part(std::move(image));
  warn_of_bad_pixels(input, count_bad_pixels(rgb_view(image, options.layer)));
  std::optional<FieldOfView> view = field_of_view(image);
  if (options.fov) view = FieldOfView{float(*options.fov), 0};
  if (!view && tone.needs_view() && !options.quiet)
    say("{}: no field of view in its metadata: {}° across assumed (--fov)", input,
        FieldOfView{}.horizontal);
  return tone_map(image, tone, options.layer, view, in_frame);
}

void tonemap(const TonemapOptions& options) {
  const auto tone = operator_of(options);
  const std::vector<std::vector<std::string>> outputs = outputs_of(options);
  check_outputs(options, outputs);
  // One image that cannot be read or written does not cost the others.
  Failures failures;
  for (size_t i = 0; i < options.inputs.size(); ++i)
    failures.attempt_to("show '" + options.inputs[i] + "'", [&] {
      const Image image = shown(options, options.inputs[i], *tone);
      for (const std::string& output : outputs[i])
        failures.attempt(output, [&] { write_shown_picture(image, output, options.quality); });
    });
  failures.throw_if_any();
}

}  // namespace

void add_tonemap(CLI::App& program) {
  CLI::App* command = program.add_subcommand(
      "tonemap", "Convert high dynamic range images (exr, hdr, pfm, LogLuv tif) for displays.");
  command->footer(
      "Every parameter of every operator: kaustik help tonemap\n"
      "Several images: kaustik tonemap a.exr b.exr -o pictures/");
  auto o = std::make_shared<TonemapOptions>();
  takes_files(command->add_option("inputs", o->inputs, "Images to read")->required(),
              picture_extensions());
  takes_files(
      command
          ->add_option("-o,--output", o->outputs,
                       "png, jpg, ppm or tif (8 bits) to write, or a folder, or - (jpg:- …) for "
                       "standard output; may be repeated")
          ->required()
          ->take_all()
          ->allow_extra_args(false),
      shown_extensions());
  takes_words(command->add_option("--operator", o->tone, "Tone mapping operator [histogram]"),
              tone_operator_names());
  command
      ->add_option("--set", o->settings,
                   "Change a parameter of the operator, such as human=true or key=0.36")
      ->type_name("PARAMETER=VALUE")
      ->allow_extra_args(false);
  takes(command->add_option("--layer", o->layer,
                            "Layer of an EXR, such as caustic [the picture itself]"),
        "LAYER");
  command->add_option("--exposure", o->exposure, "The same as --set exposure=…");
  command->add_option("--fov", o->fov, "Horizontal field of view, degrees [from the file, else 50]")
      ->check(number_between(0, 180));
  command->add_option("--display-maximum", o->display_maximum,
                      "The same as --set display_maximum=…");
  command->add_option("--display-range", o->display_range, "The same as --set display_range=…");
  command->add_option("--quality", o->quality, "Of jpg [95]")->check(whole_number(1, 100));
  auto* data_window = command->add_flag(
      "--data-window", o->data_window,
      "Show only the pixels that the EXR has [for crop windows that kaustik rendered]");
  command
      ->add_flag("--display-window", o->display_window,
                 "Show the whole picture, black where the EXR has no pixels [for all others]")
      ->excludes(data_window);
  command->add_flag("--force", o->force, "Replace an input image");
  command->add_flag("-q,--quiet", o->quiet, "No notes");
  command->callback([o] { tonemap(*o); });
}

}  // namespace kaustik::app
