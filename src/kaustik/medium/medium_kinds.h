#pragma once
// The entries of medium_types() and phase_function_types(), one per source file.

#include "kaustik/medium/medium.h"

namespace kaustik {

MediumType homogeneous_type();
MediumType heterogeneous_type();

PhaseFunctionType isotropic_type();
PhaseFunctionType henyey_greenstein_type();
PhaseFunctionType rayleigh_type();
PhaseFunctionType blendphase_type();
PhaseFunctionType tabphase_type();

}  // namespace kaustik
