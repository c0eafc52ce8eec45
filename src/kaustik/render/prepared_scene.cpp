#include "kaustik/render/prepared_scene.h"

#include <fmt/format.h>

#include <exception>

#include "kaustik/base/memory.h"
#include "kaustik/integrator/description_types.h"
#include "kaustik/integrator/override_integrator.h"
#include "kaustik/render/measuring.h"
#include "kaustik/render/scene_warnings.h"
#include "kaustik/render/session.h"
#include "kaustik/scene/deviation_report.h"
#include "kaustik/scene/mesh_memory.h"

namespace kaustik {
namespace {

/// Meshes that take less are not worth a word.
constexpr uint64_t much_memory = 500'000'000;

PictureFrame frame_of(const FilmSettings& film) {
  return {film.size.x, film.size.y, film.crop_offset.x, film.crop_offset.y};
}

ViewFacts facts_of(const Scene& scene, const std::string& integrator) {
  return {integrator,
          double(scene.camera().traits().horizontal_fov),
          double(scene.camera().traits().vertical_fov),
          scene.quantity(),
          double(scene.film().exposure),
          frame_of(scene.film())};
}

}  // namespace

void apply_changes(Description& description, const RenderRecipe& recipe, const Messages& messages,
                   const std::string& integrator_origin) {
  if (!recipe.points.empty())
    description = measuring(description, "irradiancepoints", {{"filename", recipe.points, {}}});
  else if (const std::string others = choose_camera(description, recipe.camera); !others.empty())
    messages.tell(others);
  if (!recipe.integrator.empty())
    if (const std::string left_out =
            override_integrator(description, recipe.integrator, place_in(integrator_origin));
        !left_out.empty())
      messages.tell(left_out);
  for (const Setting& setting : recipe.settings) override_property(description, setting);
}

void tell_of_memory(const Description& description, const Messages& messages) {
  const uint64_t bytes = expected_mesh_memory(description);
  if (bytes < much_memory) return;
  const auto gigabytes = [](auto count) { return fmt::format("{:.1f} GB", double(count) / 1e9); };
  messages.tell(
      fmt::format("reading large meshes: they will take up to {} of memory", gigabytes(bytes)));
  if (bytes > uint64_t(physical_memory_bytes()))
    messages.warn(fmt::format("this machine has {}: the program may be stopped for lack of memory",
                              gigabytes(physical_memory_bytes())));
}

std::shared_ptr<const Scene> build_scene_and_tell(const Description& description,
                                                  const BuildOptions& build,
                                                  const Messages& messages,
                                                  const std::shared_ptr<const Scene>& previous) {
  tell_of_memory(description, messages);
  auto scene = build_scene(description, previous, build);
  if (const std::string deviations = deviation_summary(description); !deviations.empty())
    messages.warn(deviations);
  for (const std::string& warning : scene_warnings(*scene)) messages.warn(warning);
  return scene;
}

PreparedScene prepare_scene(const Description& description, const BuildOptions& build,
                            bool with_digest, const Messages& messages,
                            const std::shared_ptr<const Scene>& previous) {
  PreparedScene prepared;
  std::exception_ptr unreadable;
  std::optional<GuardedDigest> digest;
  if (with_digest) {
    try {
      digest.emplace(description, description_types());
    } catch (const Error&) {
      unreadable = std::current_exception();
    }
  }
  // Tells of a file that cannot be read where it is named.
  prepared.scene = build_scene_and_tell(description, build, messages, previous);
  if (unreadable) std::rethrow_exception(unreadable);
  std::vector<std::string> warnings;
  prepared.integrator = make_integrator(description, *prepared.scene, warnings);
  if (digest) {
    digest->check(description);
    prepared.digest = digest->digest();
  }
  const std::string type = integrator_type(description, *prepared.scene);
  warnings.push_back(darkness_warning(*prepared.scene));
  warnings.push_back(hidden_lamps_warning(*prepared.scene, type));
  for (const std::string& warning : warnings)
    if (!warning.empty()) messages.warn(warning);
  prepared.view = facts_of(*prepared.scene, type);
  return prepared;
}

}  // namespace kaustik
