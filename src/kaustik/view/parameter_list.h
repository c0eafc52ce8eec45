#pragma once
#include "kaustik/scene/description.h"
#include "kaustik/view/json_text.h"

namespace kaustik::view {

/// All named objects with those of their parameters that a page can show and set, by their tables;
/// and the integrators that may be chosen. A texture in a value's place hides it.
Json parameter_list(const Description& description);

/// Of the integrator that the description asks for, "auto" if it names none.
std::string integrator_of(const Description& description);

}  // namespace kaustik::view
