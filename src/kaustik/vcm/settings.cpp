#include "kaustik/vcm/settings.h"

#include <fmt/format.h>

#include <algorithm>

#include "kaustik/transport/integrator.h"
#include "kaustik/transport/integrator_parameters.h"

namespace kaustik {
namespace {

Parameter adaptive_parameter() {
  return boolean_parameter("adaptive", true,
                           "Gives more samples to pixels whose samples differed in earlier passes, "
                           "at the cost of others. Only if light paths may merge.");
}

/// The table of a preset.
std::vector<Parameter> parameters(const Techniques& preset) {
  std::vector<Parameter> rows = {
      components_parameter(),
      max_depth_parameter(),
      rr_depth_parameter(),
      aim_parameter(),
      boolean_parameter("guiding", true,
                        "Light paths learn from those that reach the surfaces in view: at which "
                        "lights to begin, and where to go. A fraction stays unguided."),
      boolean_parameter("guided_scattering", true,
                        "Guided light paths also learn where to go on from matt surfaces."),
      boolean_parameter("unidirectional", preset.unidirectional,
                        "Counts lights that camera paths hit by chance."),
      boolean_parameter("next_event", preset.next_event,
                        "Samples lights at the vertices of camera paths."),
      boolean_parameter("splats", preset.splats,
                        "Connects the vertices of light paths to the camera."),
      boolean_parameter("connections", preset.connections,
                        "Connects the vertices of camera paths to vertices of light paths."),
      boolean_parameter("merging", preset.merging,
                        "Merges vertices of light paths near a vertex of a camera path, as if they "
                        "were there (photon mapping)."),
      number_parameter("light_paths", 0.25, "Light paths per camera sample.").range(0.001, 1000),
      boolean_parameter("choose_light_paths", false,
                        "A pilot chooses the number of light paths, or none; it starts from "
                        "light_paths. With it ppm becomes auto."),
      integer_parameter(
          "connection_samples", 1,
          "Number of light vertices to which each vertex of a camera path is connected.")
          .range(1, 1024),
      integer_parameter("merge_neighbors", 30,
                        "Number of light vertices for which the first radius of merging is made, "
                        "if radii are not learned.")
          .range(1, 1 << 20),
      number_parameter("radius", 0,
                       "Radius of merging in the first pass; it shrinks from pass to pass. 0: "
                       "learned, or derived from the density of light paths.")
          .range(0, 1e30)
          .in("m"),
      boolean_parameter("learn_radii", true,
                        "Learns radii from the light paths of a pilot and of earlier passes. If "
                        "false, the radii of the first pass shrink."),
      boolean_parameter("edges", true,
                        "Ends merging disks at straight edges around them. A gradient of the "
                        "irradiance does not bias their kernels."),
      boolean_parameter("visibility", true,
                        "Merges only light vertices that nothing opaque hides."),
      boolean_parameter("choose_survival", true,
                        "A pilot chooses, place by place, how often camera paths go on where they "
                        "also merge. If false, they always go on."),
      boolean_parameter("choose_light_samples", true,
                        "With merging, a pilot chooses, place by place, how many lights the first "
                        "vertex of a camera path samples. If false, it samples one."),
      choice_parameter(
          "indirect_cache", "choose", {"never", "choose", "always"},
          "Gathers diffuse indirect light at some points in view and interpolates it where it is "
          "smooth: never, where a pilot finds that it pays, or always. Needs merging, next_event "
          "and unidirectional, no splats or connections, and no scattering medium."),
      integer_parameter("samples_per_pass", 4, "Samples per pixel and pass.").range(1, 1 << 20),
      adaptive_parameter(),
      hide_emitters_parameter()};
  return rows;
}

}  // namespace

const TypeInfo& vcm_info() {
  static const TypeInfo info{"integrator", "vcm",
                             "Vertex connection and merging: combines paths from the camera and "
                             "the lights in every way. Each way can be switched off.",
                             parameters({.splats = true, .connections = true, .merging = true})};
  return info;
}

const TypeInfo& bdpt_info() {
  static const TypeInfo info{"integrator", "bdpt",
                             "Bidirectional path tracing: vcm without merging, unbiased.",
                             parameters({.splats = true, .connections = true})};
  return info;
}

const TypeInfo& ppm_info() {
  static const TypeInfo info{"integrator", "ppm",
                             "Progressive photon mapping: vcm with merging at camera vertices, "
                             "light sampling, and lights hit by chance.",
                             parameters({.merging = true})};
  return info;
}

const TypeInfo& auto_info() {
  static const TypeInfo info{"integrator",
                             "auto",
                             "Chooses by itself, region by region, between camera paths and light "
                             "paths that merge with them. Needs no parameter.",
                             {components_parameter(), max_depth_parameter(), rr_depth_parameter(),
                              adaptive_parameter(), hide_emitters_parameter()}};
  return info;
}

namespace {

CacheUse read_cache_use(const std::string& text) {
  if (text == "never") return CacheUse::never;
  return text == "always" ? CacheUse::always : CacheUse::choose;
}

}  // namespace

VcmSettings::VcmSettings(const Arguments& arguments)
    : components(read_components(arguments)),
      maximum_events(read_maximum_events(arguments)),
      roulette_depth(int(arguments.integer("rr_depth"))),
      adaptive(arguments.boolean("adaptive")) {
  // By its name: tables are copied.
  if (arguments.info().name == auto_info().name) {
    techniques.merging = true;
    chooses_light_paths = true;
    return;
  }
  aim = read_aim(arguments.text("aim"));
  guiding = arguments.boolean("guiding");
  guided_scattering = arguments.boolean("guided_scattering");
  light_paths = float(arguments.number("light_paths"));
  chooses_light_paths = arguments.boolean("choose_light_paths");
  connections = int(arguments.integer("connection_samples"));
  merge_neighbors = int(arguments.integer("merge_neighbors"));
  radius = float(arguments.number("radius"));
  learn_radii = arguments.boolean("learn_radii");
  edges = arguments.boolean("edges");
  visibility = arguments.boolean("visibility");
  choices = {.survival = arguments.boolean("choose_survival"),
             .light_samples = arguments.boolean("choose_light_samples"),
             .cache = read_cache_use(arguments.text("indirect_cache"))};
  samples_per_pass = uint32_t(arguments.integer("samples_per_pass"));
  techniques = {.unidirectional = arguments.boolean("unidirectional"),
                .next_event = arguments.boolean("next_event"),
                .splats = arguments.boolean("splats"),
                .connections = arguments.boolean("connections"),
                .merging = arguments.boolean("merging")};
}

namespace {

/// Whether the parameter was given, with that value.
bool has_asked(const Arguments& arguments, const char* name, bool value) {
  return arguments.info().find(name) && arguments.given(name) && arguments.boolean(name) == value;
}

void adapt_to_media(const Arguments& arguments, VcmSettings& settings) {
  if (settings.guides_light_paths())
    settings.decisions.emplace_back(
        "media scatter light: light paths are not guided, since of what use they are can be told "
        "on surfaces only");
  for (const char* name : {"guiding", "guided_scattering"})
    if (settings.guides_light_paths() && has_asked(arguments, name, true))
      settings.warnings.push_back(
          fmt::format("{} has no effect where media scatter light: leave it out", name));
  settings.guiding = false;
  // The pilot knows of surfaces alone, too, and then can't choose. What few vertices merge in thin
  // media leaves bright dots that connections take off.
  if (!settings.chooses_light_paths) return;
  settings.decisions.emplace_back(
      "media scatter light, of which a pilot knows nothing: vertices of light paths are connected "
      "to the camera and to its paths, too");
  for (const char* name : {"splats", "connections"})
    if (has_asked(arguments, name, false))
      settings.warnings.push_back(fmt::format(
          "{} can't be left out where media scatter light and a pilot chooses: leave out "
          "choose_light_paths",
          name));
  settings.techniques.splats = settings.techniques.connections = true;
}

void adapt_to_camera(const Arguments& arguments, const Camera& camera, VcmSettings& settings) {
  if (camera.traits().can_connect || !settings.techniques.splats) return;
  const std::string why = "no light path can be connected to a meter: splats are left out";
  if (has_asked(arguments, "splats", true))
    settings.warnings.push_back(why);
  else
    settings.decisions.push_back(why);
  settings.techniques.splats = false;
}

/// Nothing is learned of one pixel from those beside it. Light paths per camera sample and pixel:
/// each is to be known well.
constexpr float light_paths_of_pixels_apart = 512;
/// Of a pass: a meter's picture is a number, for which pixels would ask for next to none. Few would
/// miss focused light, in all passes alike, and the error would not tell.
constexpr float least_light_paths_of_meter = 8192;

void adapt_to_few_pixels(const Arguments& arguments, const CameraTraits& camera,
                         const FilmSettings& film, VcmSettings& settings) {
  if (camera.are_pixels_apart()) settings.learn_radii = settings.edges = false;
  const bool is_given = arguments.info().find("light_paths") && arguments.given("light_paths");
  if (camera.can_connect || is_given) return;
  settings.least_light_paths = least_light_paths_of_meter;
  const float pixels = float(film.size.x) * float(film.size.y);
  if (camera.are_pixels_apart())
    settings.light_paths = std::max(settings.light_paths, light_paths_of_pixels_apart / pixels);
}

/// Lamps that only paths from the camera meet: gather rays, which count no lamps that they meet,
/// would lose their light.
bool has_lamps_only_seen(const Scene& scene) {
  const auto& lights = scene.lights();
  return std::any_of(
      scene.environment_lights().begin(), scene.environment_lights().end(),
      [&](int index) { return lights[size_t(index)]->distant().traits().is_only_seen; });
}

/// The cache has all of its component, which other techniques must not find again.
void adapt_cache(const Scene& scene, VcmSettings& settings) {
  const Techniques& techniques = settings.techniques;
  const bool can_be = techniques.merging && techniques.next_event && techniques.unidirectional &&
                      !techniques.splats && !techniques.connections &&
                      settings.components.has(Component::indirect) && !scene.has_scattering() &&
                      scene.gauges().empty() && !has_lamps_only_seen(scene) &&
                      !scene.camera().traits().are_pixels_apart() &&
                      scene.film().quantity == Quantity::radiance;
  if (can_be) return;
  if (settings.choices.cache == CacheUse::always)
    settings.warnings.emplace_back(
        "indirect_cache has no effect here: it needs merging, next_event and unidirectional, no "
        "splats or connections, no medium that scatters light, the component indirect, and a "
        "camera "
        "whose pixels see radiance side by side");
  settings.choices.cache = CacheUse::never;
}

}  // namespace

VcmSettings settings_for(const Scene& scene, const Arguments& arguments) {
  VcmSettings settings(arguments);
  if (scene.has_scattering()) adapt_to_media(arguments, settings);
  adapt_to_camera(arguments, scene.camera(), settings);
  adapt_to_few_pixels(arguments, scene.camera().traits(), scene.film(), settings);
  adapt_cache(scene, settings);
  return settings;
}

}  // namespace kaustik
