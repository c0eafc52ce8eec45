#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <optional>

#include "commands.h"
#include "console.h"
#include "kaustik/base/parallel.h"
#include "kaustik/image/denoise.h"
#include "kaustik/image/image_io.h"
#include "kaustik/loader/mitsuba_xml.h"
#include "kaustik/scene/overrides.h"
#include "thesis_settings.h"

namespace kaustik::app {
namespace {

struct RenderOptions {
  std::string scene;
  std::vector<std::string> outputs, definitions, settings, tone_settings;
  std::string integrator, time, tone = "histogram";
  std::optional<uint32_t> passes, spp;
  LevelOptions levels;
  uint64_t seed = 0;
  int threads = 0;
  std::optional<double> exposure;
  bool denoise = false, full_float = false, reproducible = false, quiet = false;
};

/// "60", "60s", "5m", "1h" in seconds.
double parse_duration(const std::string& text) {
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string unit(end, text.data() + text.size());
  const double factor = unit.empty() || unit == "s"    ? 1
                        : unit == "m" || unit == "min" ? 60
                        : unit == "h"                  ? 3600
                                                       : 0;
  if (code != std::errc{} || factor == 0 || !(value > 0) || !std::isfinite(value))
    throw Error(ErrorKind::input, fmt::format("cannot read the time '{}'", text),
                "write a positive number of seconds (60s), minutes (5m) or hours (1h)");
  return value * factor;
}

void set_metadata(Image& image, const RenderOptions& options, const Scene& scene,
                  const std::string& integrator, const SessionReport& report) {
  image.set_metadata("software", std::string("Kaustik ") + KAUSTIK_VERSION);
  image.set_metadata("scene", options.scene);
  image.set_metadata("integrator", integrator);
  image.set_metadata("seed", int64_t(options.seed));
  image.set_metadata("passes", int64_t(report.passes));
  image.set_metadata("samples_per_pixel", int64_t(report.passes) * report.samples_per_pass);
  image.set_metadata("horizontal_fov", double(scene.camera().horizontal_fov()));
  image.set_metadata("vertical_fov", double(scene.camera().vertical_fov()));
  image.set_metadata(
      "quantity",
      std::string(scene.film().quantity == Quantity::irradiance ? "irradiance" : "radiance"));
  if (report.incomplete_pass) image.set_metadata("incomplete", std::string("cancelled in pass 1"));
  if (!options.reproducible) image.set_metadata("render_seconds", report.seconds);
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

/// "tonemap.key=0.3" is for the tone mapping operator, everything else for the scene.
void sort_settings(RenderOptions& options) {
  const std::string prefix = "tonemap.";
  const auto for_scene = std::stable_partition(
      options.settings.begin(), options.settings.end(),
      [&](const std::string& setting) { return !setting.starts_with(prefix); });
  for (auto setting = for_scene; setting != options.settings.end(); ++setting)
    options.tone_settings.push_back(setting->substr(prefix.size()));
  options.settings.erase(for_scene, options.settings.end());
  if (options.exposure)
    options.tone_settings.push_back(fmt::format("exposure={}", *options.exposure));
}

void write_outputs(const Image& image, const RenderOptions& options,
                   std::shared_ptr<const ToneOperator> tone) {
  WriteOptions write;
  write.exr_half = !options.full_float;
  write.tone = std::move(tone);
  for (const std::string& output : options.outputs) {
    write_image(image, output, write);
    if (!options.quiet) fmt::print(stderr, "wrote {}\n", output);
  }
}

void render(RenderOptions options) {
  if (options.outputs.empty())
    options.outputs.push_back(std::filesystem::path(options.scene).stem().string() + ".exr");
  for (const std::string& output : options.outputs) check_writable(output);
  sort_settings(options);
  const auto tone = make_tone_operator(options.tone, options.tone_settings);
  SessionSettings settings;
  settings.seed = options.seed;
  settings.threads = usable_threads(options.threads);
  settings.passes = options.passes;
  settings.samples_per_pixel = options.spp;
  if (!options.time.empty()) settings.seconds = parse_duration(options.time);

  LoadOptions load;
  load.definitions = parse_definitions(options.definitions);
  Description description = load_mitsuba_xml(options.scene, load);
  if (!options.integrator.empty()) override_integrator(description, options.integrator);
  apply_settings(description, options.levels, options.settings);
  const auto scene = build_scene(description);
  std::vector<std::string> warnings = scene->warnings();
  const auto integrator = make_integrator(description, *scene, warnings);
  for (const std::string& warning : warnings) warn(warning);
  if (scene->lights().empty())
    warn("the scene has no light: the picture will be black; add an <emitter> to it");

  Session session(*scene, *integrator, settings);
  const InterruptGuard interrupt;
  ProgressLine line(options.quiet);
  const SessionReport report =
      session.run(interrupt.token(), [&](const Progress& p) { line.show(p); });
  line.finish();
  if (!options.quiet && std::isfinite(report.mean_error))
    fmt::print(stderr, "mean of the picture: ±{:.2g} % (95 % confidence, {} passes)\n",
               100 * report.mean_error, report.passes);
  for (const std::string& warning : report.warnings) warn(warning);
  if (report.cancelled) warn("cancelled: writing what is finished");
  const auto object = find_integrator(description);
  Image image = session.film().image();
  set_metadata(image, options, *scene, object ? object->type : "photonmap", report);
  if (options.denoise) with_threads(settings.threads, [&] { smooth_noise(image); });
  write_outputs(image, options, tone);
}

}  // namespace

std::vector<std::pair<std::string, std::string>> parse_definitions(
    const std::vector<std::string>& texts) {
  std::vector<std::pair<std::string, std::string>> definitions;
  for (const std::string& text : texts) {
    const size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
      throw Error(ErrorKind::input, fmt::format("cannot read the definition '{}'", text),
                  "write -D name=value");
    definitions.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
  return definitions;
}

void add_render(CLI::App& program) {
  CLI::App* command = program.add_subcommand("render", "Render a scene to image files.");
  command->footer(
      "Ctrl-C (SIGINT, SIGTERM) ends the render, writes what is finished and exits with 0; a "
      "second "
      "one ends the program at once.\n"
      "Variables photonMap.… of the environment set integrator photonmap as in Schregle's thesis: "
      "kaustik help thesis.");
  auto options = std::make_shared<RenderOptions>();
  command->add_option("scene", options->scene, "Scene file (Mitsuba XML)")->required();
  command
      ->add_option("-o,--output", options->outputs,
                   "Image to write, by extension: exr, hdr, pfm, tif (LogLuv), png, jpg, ppm; may "
                   "be repeated [SCENE.exr]")
      ->take_all()
      ->allow_extra_args(false);
  command->add_option("-D,--define", options->definitions, "Value for $name in the scene file")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  command
      ->add_option(
          "--set", options->settings,
          "Change a parameter: integrator.caustic_neighbors=200, film.width=400, ID.radius=2")
      ->type_name("OBJECT.PARAMETER=VALUE")
      ->allow_extra_args(false);
  command->add_option("--integrator", options->integrator,
                      "Use this method instead of the file's: photonmap, path, lighttracer, "
                      "raytracing, localphong");
  add_light_level(*command, options->levels);
  add_eye_level(*command, options->levels);
  command->add_option("--passes", options->passes, "Number of passes")
      ->check(CLI::Range(1u, 1u << 30));
  command->add_option("--spp", options->spp, "Samples per pixel over all passes")
      ->check(CLI::Range(1u, 1u << 30));
  command->add_option("--time", options->time, "Stop in time: 60s, 5m, 1h (one pass at least)");
  command->add_option("--seed", options->seed, "Seed of all random numbers [0]");
  command->add_option("--threads", options->threads, "Threads; 0: all [0]")
      ->check(CLI::Range(0, 4096));
  command->add_option(
      "--tonemap", options->tone,
      fmt::format("For 8-bit images: {} [histogram]; its parameters: --set tonemap.key=0.3",
                  fmt::join(tone_operator_names(), ", ")));
  command->add_option("--exposure", options->exposure, "The same as --set tonemap.exposure=…");
  command->add_flag("--float", options->full_float, "EXR with 32-bit instead of 16-bit floats");
  command->add_flag("--denoise", options->denoise,
                    "Smooth the picture's noise (the EXR's layers keep it): kaustik denoise");
  command->add_flag("--reproducible", options->reproducible,
                    "Write no times, so that equal renders are equal files");
  command->add_flag("-q,--quiet", options->quiet, "No progress");
  command->callback([options] { render(*options); });
}

}  // namespace kaustik::app
