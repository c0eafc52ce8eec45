#pragma once
#include "kaustik/transport/integrator.h"
#include "kaustik/transport/path_class.h"
#include "kaustik/transport/vertex.h"
#include "kaustik/vcm/lessons/light_path_emission.h"
#include "kaustik/vcm/light_vertices.h"
#include "kaustik/vcm/merging/medium_disks.h"
#include "kaustik/vcm/plan/pixel_plans.h"

namespace kaustik {

/// What a light pass of connection and merging is made of.
struct VcmLightInputs {
  const Scene& scene;
  const LightPathEmission& emission;
  const PathWeights& weights;
  ComponentSet components = ComponentSet::all();
  int maximum_events = any_number_of_events;
  uint32_t light_paths = 1;  ///< of the set
  size_t set = 0;            ///< of the pass's wavelengths
  float camera_samples = 1;  ///< per pixel
  const PixelPlans& plans;
  float shrinkage = 1;  ///< of the disks of merging since the first pass
  /// Paths whose beginnings are remembered; their vertices are kept as if merging were wanted.
  uint32_t remembered_paths = 0;
  MediumDisks media = {};
  const ScatterGuide* scattering = nullptr;  ///< null: none is guided
  bool remembers_scattering = false;         ///< of the paths whose beginnings are remembered
  /// Within which light merges at gauges; null: it does not. Must outlive the vertices.
  const GaugeDisks* gauges = nullptr;
};

/// Traces the light paths of a pass, keeps their vertices, and splats them where that is one of the
/// techniques. The same for any number of threads.
LightVertices trace_light_vertices(const VcmLightInputs& inputs, const Pass& pass, Stream stream,
                                   SplatBuffer& splats, std::stop_token stop,
                                   const ProgressFunction& progress, PassReport& report);

}  // namespace kaustik
