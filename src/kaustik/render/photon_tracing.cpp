#include "kaustik/render/photon_tracing.h"

#include "kaustik/base/parallel.h"
#include "kaustik/base/sampler.h"
#include "kaustik/integrator/foreign_integrators.h"
#include "kaustik/integrator/make_integrator.h"
#include "kaustik/photon/photon_lamps.h"
#include "kaustik/photon/photon_parts.h"
#include "kaustik/photonmap/photon_map_settings.h"
#include "kaustik/scene/part_keys.h"
#include "kaustik/scene/scene_report.h"

namespace kaustik {
namespace {

/// A copy of the description's photonmap integrator that traces its photons, or one with the
/// default parameters.
std::shared_ptr<Object> photonmap_of(const Description& description,
                                     std::vector<std::string>& notes) {
  const std::string& type = PhotonMapSettings::info().name;
  const auto given = find_integrator(description);
  auto object = std::make_shared<Object>();
  object->family = "integrator";
  object->type = type;
  if (!given || native_type(*given) != type) return object;
  *object = native_integrator(*given, notes, description.is_strict);
  // The map that it asks for may be the one that is about to be written.
  std::erase_if(object->properties, [](const Property& p) { return p.name == "photon_map"; });
  return object;
}

/// As that integrator has them. Throws Error(input) for wrong parameters.
LightPassSettings light_pass_settings(const Description& description, const Scene& scene,
                                      std::vector<std::string>& warnings) {
  const auto object = photonmap_of(description, warnings);
  // Checks the object as a render would, but not the surfaces' own, which photons don't know.
  make_integrator_alone(*object, scene, warnings, description.is_strict);
  Problems problems;
  UnknownParameters told;
  const Arguments arguments(PhotonMapSettings::info(),
                            told.without_unknown(PhotonMapSettings::info(), object->properties),
                            object->place, problems);
  problems.throw_if_any();
  return PhotonMapSettings(arguments).light_pass;
}

/// Why a map is empty where LightPass finds nothing wrong.
void explain_empty_maps(const StoredPhotons& photons, std::vector<std::string>& warnings) {
  const LightPassSettings& settings = photons.settings;
  if (settings.global_photons == 0)
    warnings.emplace_back("the global map is empty: no global photons are asked for");
  else if (nothing_lit_twice(photons.maps.global_report))
    warnings.emplace_back("the global map is empty: no surface sends light to another");
  if (settings.caustic_photons == 0)
    warnings.emplace_back("the caustic map is empty: no caustic photons are asked for");
  else if (photons.maps.caustic_report.target_count == 0)
    warnings.emplace_back(
        "the caustic map is empty: the scene has no specular object that could focus light");
}

}  // namespace

TracedPhotons trace_photon_maps(const Description& description, const Scene& scene, uint64_t seed,
                                int threads, std::stop_token stop, const ProgressFunction& progress,
                                PhotonPart part) {
  if (scene.film().is_spectral)
    throw Error(ErrorKind::input,
                "files of photons hold red, green and blue, and the film asks for wavelengths",
                "set the film's 'color' to rgb", scene.film().place);
  TracedPhotons traced;
  StoredPhotons& photons = traced.photons;
  photons.fingerprint = fingerprint_of(scene);
  photons.seed = seed;
  photons.settings = light_pass_settings(description, scene, traced.warnings);
  photons.settings.part = part;
  photons.settings.volume_photons = 0;  // files have no place for them
  const uint64_t refused_before = scene.tracer().refused_rays();
  with_threads(threads, [&] {
    const LightPass pass(scene, photons.settings, seed, stop);
    photons.maps = pass.trace(seed, 0, stop, progress, photons.wavelengths);
    sort_photons(photons.maps);
    for (const std::string& warning : pass.warnings(photons.maps))
      traced.warnings.push_back(warning);
  });
  if (stop.stop_requested())
    throw Error(ErrorKind::system, "cancelled before the photon maps were complete");
  explain_empty_maps(photons, traced.warnings);
  if (const uint64_t refused = scene.tracer().refused_rays() - refused_before)
    traced.warnings.push_back(refused_rays_warning(refused));
  return traced;
}

std::vector<uint32_t> lamps_of(const StoredPhotons& photons, const PhotonMap& map) {
  const PhotonLamps lamps(photons.settings, photons.maps);
  std::vector<uint32_t> indices(map.size());
  for (uint32_t i = 0; i < indices.size(); ++i) indices[i] = lamps.of_path(map.tree().data(i).path);
  return indices;
}

DrawnPhotons draw_photons(const Description& description, const Scene& scene, uint64_t seed,
                          int threads, size_t most, std::stop_token stop) {
  std::vector<std::string> warnings;
  const LightPassSettings settings = light_pass_settings(description, scene, warnings);
  DrawnPhotons drawn;
  with_threads(threads,
               [&] { drawn = LightPass(scene, settings, seed, stop).draw(seed, 0, most, stop); });
  return stop.stop_requested() ? DrawnPhotons() : drawn;
}

uint64_t drawn_photons_key(const Description& description, const Scene& scene, uint64_t seed) {
  std::vector<std::string> warnings;
  const uint64_t world = hash_mix(scene.built().world, uint64_t(scene.quantity()));
  return hash_mix(hash_mix(world, PartKeys().whole(*photonmap_of(description, warnings))), seed);
}

}  // namespace kaustik
