#pragma once
#include "kaustik/transport/path_weights.h"
#include "kaustik/vcm/gathering/indirect_cache.h"
#include "kaustik/vcm/lessons/light_path_emission.h"
#include "kaustik/vcm/light_vertices.h"
#include "kaustik/vcm/merging/light_tails.h"
#include "kaustik/vcm/merging/matt_merging.h"
#include "kaustik/vcm/merging/medium_disks.h"
#include "kaustik/vcm/plan/pixel_plans.h"

namespace kaustik {

/// What camera paths of a pass share.
struct CameraPathInputs {
  const Scene& scene;
  const LightPathEmission& emission;
  const PathWeights& weights;
  const LightVertices& light;
  const MattMerging& matt;
  /// Of focused_vertices() alone, for where nothing else merges; null: `matt` tells them apart.
  const MattMerging* focused_matt = nullptr;
  const LightTails* tails = nullptr;  ///< null: weights go along the light paths themselves
  const SeenSurfaces& seen;
  float camera_samples = 1;    ///< per pixel
  float connection_scale = 0;  ///< of a connected vertex: vertices over paths and connections
  float merge_radius_sq = 0;   ///< at vertices that the camera does not see
  MediumDisks media = {};
  int maximum_events = any_number_of_events;
  int roulette_depth = 5;
  int connections = 1;                       ///< per vertex
  const ScatterGuide* scattering = nullptr;  ///< of light paths; null: not guided
  const IndirectCache* cache = nullptr;      ///< null: there is none
  /// By which a first vertex chooses its plan; null: it has that of its path.
  const PixelPlans* plans = nullptr;
  float shrinkage = 1;     ///< of the areas of their disks
  bool visibility = true;  ///< what is hidden does not merge

  const Techniques& techniques() const { return weights.settings().techniques; }
};

}  // namespace kaustik
