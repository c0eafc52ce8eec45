#pragma once
#include "kaustik/integrator/pixel_probes.h"
#include "kaustik/photon/emission_learning.h"
#include "kaustik/photon/light_vertices.h"

namespace kaustik {

/// Of what use light paths are for the picture, and what that teaches emission. At one probe per
/// block of pixels, a vertex of a light path nearby is of use by what it would bring, were its path
/// the only one, over all the light that the probe sends to the camera; by no more than all paths
/// of a pass together. The use of a path is the root of the sum of their squares.
class LightPathUse {
 public:
  /// Paths that a pass remembers the beginnings of, at most.
  static constexpr uint32_t most_pilot_paths = 1 << 17, most_paths = 1 << 15;

  /// `plain`, which must outlive this, is what is to be guided, for the picture of the `wanted`
  /// components.
  LightPathUse(const Scene& scene, const LightPathEmission& plain, ComponentSet wanted);

  /// Boxes that hold all probes, to search by.
  std::vector<AimTarget> targets() const;

  /// Learns from the next pass: from its paths whose beginnings are remembered.
  void learn(const LightVertices& light);
  const EmissionLearning& emission() const { return emission_; }

 private:
  /// A vertex near a probe.
  struct Arrival {
    uint32_t probe, beginning;
    float light;  ///< that it would send to the camera, were its path the only one
  };
  std::vector<Arrival> arrivals(const LightVertices& light) const;
  /// Of each probe: all the light that it sends to the camera, with a floor.
  std::vector<double> totals() const;

  ComponentSet wanted_;
  std::vector<PixelProbe> probes_;
  std::vector<float> direct_;    ///< light that the probes send to the camera straight from lights
  std::vector<double> arrived_;  ///< sums over the paths so far
  double paths_ = 0;
  float reach_ = 1;  ///< of the probes, in widths of a pixel there
  EmissionLearning emission_;
};

}  // namespace kaustik
