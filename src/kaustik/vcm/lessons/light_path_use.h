#pragma once
#include <stop_token>

#include "kaustik/photon/coverage/pixel_probes.h"
#include "kaustik/vcm/lessons/emission_learning.h"
#include "kaustik/vcm/light_vertices.h"

namespace kaustik {

/// Of what use light paths are for the picture, and what that teaches emission and scattering. At
/// one probe per block of pixels, a vertex of a light path nearby is of use by what it would bring,
/// were its path the only one, over all the light that the probe sends to the camera; by no more
/// than all paths of a pass together. The use of a path is the root of the sum of their squares.
class LightPathUse {
 public:
  /// Paths that a pass remembers the beginnings of, at most.
  static constexpr uint32_t most_pilot_paths = 1 << 17, most_paths = 1 << 15;

  /// `plain`, which must outlive this, is what is to be guided, for the picture of the `wanted`
  /// components.
  LightPathUse(const Scene& scene, const LightPathEmission& plain, ComponentSet wanted);

  /// Boxes that hold all probes, to search by.
  std::vector<AimTarget> targets() const;

  /// A vertex near a probe.
  struct Arrival {
    uint32_t probe;
    uint32_t path, vertex;  ///< its path's first vertex and itself, among those of the pass
    float light;            ///< that it would send to the camera, were its path the only one
  };
  /// What a pass shows of use: of its paths whose beginnings are remembered.
  struct Seen {
    std::vector<LightPathBeginning> beginnings;
    std::vector<LightScattering> scatterings;
    std::vector<Arrival> arrivals;
    uint32_t paths = 0;  ///< LightVertices::remembered_paths

    /// For read_seen().
    void write(ByteWriter& writer) const;
  };
  /// Worth nothing if it was stopped.
  Seen seen_in(const LightVertices& light, const std::stop_token& stop = {}) const;
  /// What Seen::write() wrote, of the same scene. Throws as ByteReader does.
  Seen read_seen(ByteReader& reader) const;
  /// Learns from the next pass.
  void learn(const Seen& seen);
  /// Learns nothing if it was stopped.
  void learn(const LightVertices& light, const std::stop_token& stop);
  /// The same, but for emission: of paths that are guided on trial.
  void learn_scattering(const LightVertices& light, const std::stop_token& stop);
  /// What was learned, and the same back. Reading throws as ByteReader does.
  void write(ByteWriter& writer) const;
  void read(ByteReader& reader);
  /// Forgets what paths that were not guided taught of emission: it holds for such alone.
  void forget_emission() { emission_.clear(); }

  /// Second moments of what light paths bring to the probes, relative to the light there and that
  /// of the mean; up to a common factor.
  struct Noise {
    double guided = 0;    ///< of such paths
    double unguided = 0;  ///< of paths that are scattered as if nothing had been learned
  };
  /// Told by the paths of the last lesson: guided ones find what the others do not.
  const Noise& noise() const { return noise_; }
  const EmissionLearning& emission() const { return emission_; }
  const ScatterLearning& scattering() const { return scattering_; }

 private:
  std::vector<Arrival> arrivals(const LightVertices& light, const std::stop_token& stop) const;
  Noise noise_of(const Seen& seen) const;
  /// Σ use² at and after each vertex, as squared_uses(); empty if there is nothing to learn.
  std::vector<double> look_at(const Seen& seen);
  void learn_scattering(const Seen& seen, const std::vector<double>& squares);
  /// Of one of so many paths.
  static double use_of(const Arrival& arrival, const std::vector<double>& totals, double paths);
  /// Σ use² of what comes at and after each vertex of the paths that are remembered; none of use
  /// follows the last.
  std::vector<double> squared_uses(const Seen& seen) const;
  /// Of each probe: all the light that it sends to the camera, and `floor` times the mean.
  std::vector<double> totals(double floor) const;

  size_t light_count_;  ///< of the scene
  ComponentSet wanted_;
  std::vector<PixelProbe> probes_;
  std::vector<float> direct_;    ///< light that the probes send to the camera straight from lights
  std::vector<double> arrived_;  ///< sums over the paths so far
  double paths_ = 0;
  float reach_ = 1;  ///< of the probes, in widths of a pixel there
  EmissionLearning emission_;
  ScatterLearning scattering_;
  Noise noise_;
};

}  // namespace kaustik
