#pragma once
#include <string>

#include "kaustik/scene/description.h"

namespace kaustik {

/// Replaces the scene's integrator by one of `type`, Kaustik's or another renderer's name. What the
/// description says of the one before stays where the new one has a parameter of that name that
/// takes it. Returns a sentence that names what is left out; "": nothing. Parameters without effect
/// go in silence. `place`: who asks for it, for messages about the new one.
std::string override_integrator(Description& description, const std::string& type,
                                const Place& place = place_in("integrator"));

}  // namespace kaustik
