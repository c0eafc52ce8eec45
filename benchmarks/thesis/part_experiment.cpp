// Photons traced in parts and put together are the photons of one pass.
#include <fmt/format.h>

#include <cstring>

#include "benchmarks/markdown_table.h"
#include "kaustik/photon/photon_parts.h"
#include "kaustik/render/photon_tracing.h"
#include "scene_run.h"

namespace kaustik::thesis {
namespace {

size_t differing_photons(const PhotonMap& a, const PhotonMap& b) {
  if (a.size() != b.size()) return std::max(a.size(), b.size());
  size_t count = 0;
  for (uint32_t i = 0; i < a.size(); ++i)
    count += a.tree().key(i) != b.tree().key(i) ||
             std::memcmp(&a.tree().data(i), &b.tree().data(i), sizeof(Photon)) != 0;
  return count;
}

}  // namespace

std::string photon_parts(const Workplace& place) {
  const SceneRun run("metal_ring", {"photonmap", {}, 0, 0});
  const auto trace = [&](PhotonPart part) {
    return trace_photon_maps(run.description(), run.scene(), 1, place.threads, {}, {}, part)
        .photons;
  };
  const StoredPhotons whole = trace({});
  bench::MarkdownTable table({"parts", "global photons", "caustic photons", "photons that differ"});
  for (const uint32_t count : {1u, 2u, 4u, 16u}) {
    std::vector<StoredPhotons> parts;
    for (uint32_t i = 0; i < count; ++i) parts.push_back(trace({i, count}));
    const StoredPhotons merged = merged_photons(parts);
    table.add({fmt::format("{}", count), fmt::format("{}", merged.maps.global.size()),
               fmt::format("{}", merged.maps.caustic.size()),
               fmt::format("{}", differing_photons(merged.maps.global, whole.maps.global) +
                                     differing_photons(merged.maps.caustic, whole.maps.caustic))});
  }
  return "The thesis's outlook: photons distributed in parallel and unified. `kaustik photons "
         "--part "
         "2/4` traces a share of them, `kaustik merge`\nputs the shares together. Photons of the "
         "metal ring, compared bit by bit with those of a whole pass:\n\n" +
         table.text();
}

}  // namespace kaustik::thesis
