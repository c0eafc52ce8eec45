#include "scene_run.h"

#include <fmt/format.h>

#include "benchmarks/shipped_scenes.h"
#include "kaustik/image/image_io.h"
#include "kaustik/integrator/override_integrator.h"
#include "kaustik/scene/overrides.h"

namespace kaustik::thesis {
namespace {

void use_box_filter(Object& object) {
  std::erase_if(object.children,
                [](const Child& child) { return child.object->family == "rfilter"; });
  if (object.family == "film")
    object.children.push_back(
        {"", std::make_shared<Object>(Object{"rfilter", "box", "", {}, {}, object.place})});
  for (const Child& child : object.children) use_box_filter(*child.object);
}

}  // namespace

SceneRun::SceneRun(const std::string& name, const Changes& changes, RayObserver* observer)
    : description_(bench::load_shipped(name)) {
  override_integrator(description_, changes.integrator);
  if (changes.width > 0)
    override_property(description_, fmt::format("film.width={}", changes.width));
  if (changes.height > 0)
    override_property(description_, fmt::format("film.height={}", changes.height));
  for (const std::string& setting : changes.settings) override_property(description_, setting);
  if (changes.box_filter) use_box_filter(*description_.scene);
  BuildOptions options;
  options.observer = observer;
  scene_ = build_scene(description_, options);
  std::vector<std::string> warnings;
  integrator_ = make_integrator(description_, *scene_, warnings);
}

SceneRun::Result SceneRun::render(const SessionSettings& settings) const {
  Session session(*scene_, *integrator_, settings);
  SessionReport report = session.run();
  return {session.film().image(), std::move(report)};
}

SessionSettings in_passes(uint32_t samples, uint32_t passes, uint64_t seed, int threads) {
  SessionSettings settings;
  settings.samples_per_pixel = samples;
  settings.passes = passes;
  settings.seed = seed;
  settings.threads = threads;
  return settings;
}

Image reference(const Workplace& place, const std::string& name,
                const std::function<Image()>& make) {
  const std::filesystem::path path = place.work / "references" / (name + ".exr");
  if (std::filesystem::exists(path)) return read_image(path.string());
  say("making the reference " + name);
  Image image = make();
  std::filesystem::create_directories(path.parent_path());
  WriteOptions options;
  options.exr_half = false;
  write_image(image, path.string(), options);
  return image;
}

void say(const std::string& text) { fmt::print(stderr, "# {}\n", text); }

}  // namespace kaustik::thesis
