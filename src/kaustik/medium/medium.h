#pragma once
#include <array>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "kaustik/base/sampler.h"
#include "kaustik/base/wavelengths.h"
#include "kaustik/medium/phase_function.h"
#include "kaustik/volume/volume.h"

namespace kaustik {

/// A straight way through a medium.
struct MediumSegment {
  Vec3f origin{0, 0, 0};
  Vec3f direction{0, 0, 1};  ///< unit
  float length = infinity;   ///< m, ≥ 0, may be infinite
};

/// What fills the space between surfaces; it may differ from place to place. Coefficients count per
/// scene unit. Immutable, thread-safe. No medium (a null pointer) is vacuum.
///
/// Random numbers: a flight takes one dimension pair of the sampler. A medium that needs more adds
/// a row of forks to base/draws.h, so that whoever asks needs not know how much that is. Those of a
/// flight are told apart by the pair, those of transmittances by the segment.
class Medium {
 public:
  virtual ~Medium() = default;

  /// Whether there is light that it scatters.
  bool scatters() const { return scatters_; }
  const PhaseFunction& phase() const { return *phase_; }
  /// Whether it lies at a place in the world, rather than being the same everywhere.
  virtual bool has_place() const { return false; }
  /// Whether it is the same stuff, in an object of its own perhaps: scenes may describe a medium
  /// once for every boundary.
  virtual bool is_like(const Medium& other) const = 0;

  /// σ_t, and σ_s, the part of it that is scattered.
  virtual Spectrum extinction(const Vec3f& position, const Wavelengths& wavelengths) const = 0;
  virtual Spectrum scattering(const Vec3f& position, const Wavelengths& wavelengths) const = 0;
  /// σ_t as an importance, by which densities of points are counted: the mean of the lanes in RGB
  /// mode, whatever is rendered. Above 0 where anything scatters.
  virtual float mean_extinction(const Vec3f& position) const = 0;
  /// The same of all of it: a mean over places, of which light meets some.
  virtual float typical_extinction() const = 0;

  /// Share of the light of each lane that is left at the end of the segment, or an unbiased
  /// estimate of it with little noise.
  virtual Spectrum transmittance(const MediumSegment& segment, const Wavelengths& wavelengths,
                                 const Sampler& sampler) const = 0;
  /// An unbiased estimate of it in less time, if there is one: for light between points that were
  /// themselves drawn within a medium, where more noise hardly counts.
  virtual Spectrum rough_transmittance(const MediumSegment& segment, const Wavelengths& wavelengths,
                                       const Sampler& sampler) const;
  // For many points of one segment (SegmentTransmittance), where that takes long:
  /// What the ways to all of them have in common, in an empty list; media that are quick to cross
  /// leave it empty.
  virtual void measure(const MediumSegment&, std::vector<LineKnot>&) const {}
  /// transmittance() of a segment that is the begin of the one of these knots.
  virtual Spectrum measured_transmittance(const MediumSegment& segment,
                                          const std::vector<LineKnot>& knots,
                                          const Wavelengths& wavelengths,
                                          const Sampler& sampler) const;

  /// How far light went.
  struct Flight {
    float distance = infinity;
    bool scattered = false;  ///< false: it came to the end of the segment
    /// Scattered: σ_s T(distance)/density; else T(length)/chance. Multiply the throughput by it.
    Spectrum weight;
  };
  /// Free flight along a segment, in a lane that is chosen by `shares` (≥ 0, any scale: the
  /// throughput).
  virtual Flight sample_flight(const MediumSegment& segment, const Spectrum& shares,
                               const Wavelengths& wavelengths, Sampler& sampler) const = 0;
  /// A point of the segment where light is scattered, as if it were sure to be: the density is that
  /// of free flight to a collision before its end. `scattered` is false where nothing scatters.
  virtual Flight sample_collision(const MediumSegment& segment, const Spectrum& shares,
                                  const Wavelengths& wavelengths, Sampler& sampler) const = 0;

 protected:
  Medium(std::shared_ptr<const PhaseFunction> phase, bool scatters);
  /// Whether light goes the same ways from both.
  bool has_phase_of(const Medium& other) const { return phase_looks_ == other.phase_looks_; }

 private:
  std::shared_ptr<const PhaseFunction> phase_;
  bool scatters_;
  std::array<float, 8> phase_looks_;  ///< its values for some angles, by which it is known again
};

/// What create() of a medium gets beside its arguments, built already.
struct MediumInputs {
  struct GivenVolume {
    std::shared_ptr<const Volume> volume;  ///< never null
    Place place;
  };

  const Arguments& arguments;
  std::shared_ptr<const PhaseFunction> phase;  ///< never null
  /// By the parameters that they stand for.
  std::map<std::string, GivenVolume, std::less<>> volumes = {};

  /// Null: none was given.
  const GivenVolume* volume(std::string_view name) const {
    const auto found = volumes.find(name);
    return found == volumes.end() ? nullptr : &found->second;
  }
};

struct MediumType {
  const TypeInfo& info;
  /// Throws Error(input) where arguments contradict one another. Null where it neither absorbs nor
  /// scatters: vacuum costs less.
  std::shared_ptr<const Medium> (*create)(const MediumInputs&);
};
/// "homogeneous", "heterogeneous".
const std::vector<MediumType>& medium_types();

}  // namespace kaustik
