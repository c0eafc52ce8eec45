#include "kaustik/medium/medium_kinds.h"

namespace kaustik {

const std::vector<MediumType>& medium_types() {
  static const std::vector<MediumType> types = {homogeneous_type(), heterogeneous_type()};
  return types;
}

const std::vector<PhaseFunctionType>& phase_function_types() {
  static const std::vector<PhaseFunctionType> types = {isotropic_type(), henyey_greenstein_type(),
                                                       rayleigh_type(), blendphase_type(),
                                                       tabphase_type()};
  return types;
}

}  // namespace kaustik
