// Digests of small pictures of all shipped scenes by all integrators, of the light and surfaces
// that they show and of the layers that tell errors: who changes the shape of the program compares
// them before and after. `digest_tool [NAME ...]`: scenes and integrators by name, all without one.
// They hold for one binary on one instruction set.
#include <bit>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "kaustik/integrator/override_integrator.h"
#include "kaustik/integrator/registry.h"
#include "kaustik/loader/scene_format.h"
#include "kaustik/render/session.h"
#include "kaustik/scene/overrides.h"

namespace {

using namespace kaustik;

/// Beyond the epochs of learning that begin at passes 1, 2, 4 and 8.
constexpr uint32_t passes = 9;
constexpr uint32_t samples_per_pass = 2;

const std::filesystem::path scenes_folder = std::string(KAUSTIK_SOURCE_DIR) + "/scenes";

/// Files by the scenes' names, in order of the names.
std::vector<std::string> shipped_scene_names() {
  std::set<std::string> names;
  for (const auto& folder : std::filesystem::directory_iterator(scenes_folder)) {
    const std::string name = folder.path().filename();
    if (std::filesystem::exists(folder.path() / (name + ".xml"))) names.insert(name);
  }
  return {names.begin(), names.end()};
}

std::vector<std::string> integrator_names() {
  std::vector<std::string> names;
  for (const IntegratorType& type : integrator_types()) names.push_back(type.info.name);
  return names;
}

bool tells_errors(const std::string& channel) {
  return channel.starts_with("error.") || channel.starts_with("bias.") ||
         channel.starts_with("noise.");
}

/// FNV-1a over the bytes of the channels that tell errors, or of all others.
uint64_t digest_of(const Image& image, bool of_errors) {
  uint64_t digest = 0xcbf29ce484222325u;
  for (int c = 0; c < image.channel_count(); ++c) {
    if (tells_errors(image.channel_names()[size_t(c)]) != of_errors) continue;
    for (const float value : image.channel(c)) {
      const auto bits = std::bit_cast<uint32_t>(value);
      for (int shift = 0; shift < 32; shift += 8)
        digest = (digest ^ ((bits >> shift) & 0xff)) * 0x100000001b3u;
    }
  }
  return digest;
}

Image picture_of(const std::string& scene_name, const std::string& integrator_name) {
  Description description =
      load_scene((scenes_folder / scene_name / (scene_name + ".xml")).string());
  override_integrator(description, integrator_name);
  override_property(description, "film.width=64");
  override_property(description, "film.height=48");
  const auto scene = build_scene(description);
  std::vector<std::string> warnings;
  const auto integrator = make_integrator(description, *scene, warnings);
  SessionSettings settings;
  settings.seed = 7;
  settings.passes = passes;
  settings.samples_per_pass = samples_per_pass;
  Session session(*scene, *integrator, settings);
  session.run();
  return session.film().image();
}

}  // namespace

int main(int argc, char** argv) {
  const std::set<std::string> wanted(argv + 1, argv + argc);
  const std::vector<std::string> scenes = shipped_scene_names(), integrators = integrator_names();
  const auto selected = [&](const std::vector<std::string>& names) {
    std::vector<std::string> result;
    for (const std::string& name : names)
      if (wanted.contains(name)) result.push_back(name);
    return result.empty() ? names : result;
  };
  for (const std::string& name : wanted)
    if (std::ranges::count(scenes, name) + std::ranges::count(integrators, name) == 0) {
      fmt::print(stderr, "digest_tool: '{}' is neither a shipped scene nor an integrator\n", name);
      return 2;
    }
  int failed = 0;
  for (const std::string& scene : selected(scenes))
    for (const std::string& integrator : selected(integrators)) {
      try {
        const Image picture = picture_of(scene, integrator);
        fmt::print("{:<16}{:<12}{:016x} errors {:016x}\n", scene, integrator,
                   digest_of(picture, false), digest_of(picture, true));
      } catch (const Error& error) {
        ++failed;
        fmt::print("{:<16}{:<12}{}\n", scene, integrator, error.what());
      }
      std::fflush(stdout);
    }
  return failed == 0 ? 0 : 1;
}
