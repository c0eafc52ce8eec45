#pragma once
#include <string>

#include "kaustik/scene/description.h"

namespace kaustik {

/// Changes a description from outside: `assignment` reads "object.parameter=value", where the
/// object is an id or a family that the scene has once ("integrator", "sensor", "film", "sampler",
/// "rfilter"). Replaces what the file says. Throws Error for an object that is not there.
void override_property(Description& description, const std::string& assignment);
/// The same for a change that comes from elsewhere than --set: `origin` is named if it is wrong.
void override_property(Description& description, const std::string& assignment,
                       const Place& origin);

/// Replaces the integrator by one of `type`; the file's properties stay if the type is the same.
void override_integrator(Description& description, const std::string& type);

}  // namespace kaustik
