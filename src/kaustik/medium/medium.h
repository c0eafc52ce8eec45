#pragma once
#include <memory>

#include "kaustik/base/spectrum.h"
#include "kaustik/medium/phase_function.h"

namespace kaustik {

/// What fills the space between surfaces, the same everywhere in it (homogeneous). Coefficients
/// count per scene unit. Immutable, thread-safe. No medium (a null pointer) is vacuum.
class Medium {
 public:
  /// `extinction` σ_t ≥ 0; `albedo` σ_s/σ_t in [0, 1], per lane; finite.
  Medium(const Spectrum& extinction, const Spectrum& albedo,
         std::shared_ptr<const PhaseFunction> phase = isotropic_phase_function());

  const Spectrum& extinction() const { return extinction_; }
  /// σ_s.
  const Spectrum& scattering() const { return scattering_; }
  bool scatters() const { return !scattering_.is_zero(); }
  const PhaseFunction& phase() const { return *phase_; }
  /// Whether it is the same stuff, in an object of its own perhaps: scenes may describe a medium
  /// once for every boundary. (Phase functions are told apart by their mean cosine.)
  bool is_like(const Medium& other) const;

  /// Share of the light of each lane that is left after `distance` (≥ 0, may be infinite) on a
  /// straight line: exp(−σ_t d), the law of Beer and Lambert.
  Spectrum transmittance(float distance) const;

  /// How far light went.
  struct Flight {
    float distance = infinity;
    bool scattered = false;  ///< false: it came to the end of the segment
    /// Scattered: σ_s T(distance)/density; else T(limit)/chance. Multiply the throughput by it.
    Spectrum weight;
  };
  /// Free flight along a segment of length `limit` (may be infinite). A lane is chosen by `shares`
  /// (≥ 0, any scale: the throughput) and its extinction sampled; the density is the sum over all
  /// lanes (balance heuristic), so the weight is bounded by the albedo times sum over share.
  Flight sample_flight(float limit, const Spectrum& shares, const Vec2f& u) const;
  /// A point of the segment where light is scattered, as if it were sure to be: the density is that
  /// of free flight to a collision before `limit`. `scattered` is false where nothing scatters.
  Flight sample_collision(float limit, const Spectrum& shares, const Vec2f& u) const;

 private:
  Spectrum extinction_, scattering_;
  std::shared_ptr<const PhaseFunction> phase_;
};

/// What create() of a medium gets beside its arguments: its phase function, built already.
struct MediumInputs {
  const Arguments& arguments;
  std::shared_ptr<const PhaseFunction> phase;  ///< never null
};

struct MediumType {
  const TypeInfo& info;
  /// Throws Error(input) where arguments contradict one another.
  std::shared_ptr<const Medium> (*create)(const MediumInputs&);
};
/// "homogeneous".
const std::vector<MediumType>& medium_types();

}  // namespace kaustik
