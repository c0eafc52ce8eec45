#pragma once
#include <memory>
#include <vector>

#include "kaustik/base/parameters.h"
#include "kaustik/base/vec.h"

namespace kaustik {

/// How a point of a medium distributes the light that it scatters. Directions are unit, in world
/// space, and point away from the point: `wo` back to where the path came from, `wi` to where it
/// goes on; light that goes straight on has wi = −wo. Immutable, thread-safe.
class PhaseFunction {
 public:
  virtual ~PhaseFunction() = default;
  /// 1/sr; integrates to 1 over wi, so it is also the density with which sample() finds wi.
  virtual float eval(const Vec3f& wo, const Vec3f& wi) const = 0;
  virtual Vec3f sample(const Vec3f& wo, const Vec2f& u) const = 0;
  /// Mean cosine between the direction of travel before and after.
  virtual float mean_cosine() const = 0;
};

/// Even over all directions: 1/(4π).
std::shared_ptr<const PhaseFunction> isotropic_phase_function();
/// Henyey and Greenstein 1941: (1 − g²)/(4π (1 + g² − 2g cosθ)^{3/2}) for the angle θ between the
/// directions of travel; `g` in (−1, 1) is the mean cosine, above zero light goes on forward.
std::shared_ptr<const PhaseFunction> henyey_greenstein_phase_function(float g);

/// Rayleigh's of particles far smaller than the wavelength: 3 (1 + cos²θ)/(16π).
std::shared_ptr<const PhaseFunction> rayleigh_phase_function();
/// (1 − weight) times the first and weight, in [0, 1], times the second.
std::shared_ptr<const PhaseFunction> blended_phase_function(
    std::shared_ptr<const PhaseFunction> first, std::shared_ptr<const PhaseFunction> second,
    float weight);
/// Proportional to `values`, at least two, finite, none negative and not all zero, at equally
/// spaced cosines from −1 (backward) to 1 (forward), and linear between them.
std::shared_ptr<const PhaseFunction> tabulated_phase_function(const std::vector<double>& values);

/// What create() of a phase function gets beside its arguments, built already.
struct PhaseFunctionInputs {
  const Arguments& arguments;
  std::vector<std::shared_ptr<const PhaseFunction>> nested = {};  ///< as many as the type takes
};

struct PhaseFunctionType {
  const TypeInfo& info;
  /// Throws Error(input) for arguments that make none.
  std::shared_ptr<const PhaseFunction> (*create)(const PhaseFunctionInputs&);
  size_t nested = 0;  ///< phase functions that it holds
};
/// "isotropic", "hg", "rayleigh", "blendphase", "tabphase".
const std::vector<PhaseFunctionType>& phase_function_types();

}  // namespace kaustik
