#pragma once
#include <string>

#include "kaustik/scene/description.h"

namespace kaustik {

/// A change of a description from outside, see override_property().
struct Setting {
  std::string assignment;  ///< "object.parameter=value"
  std::string origin;      ///< "command line: -e 2", for messages
};

/// Changes a description from outside: `assignment` reads "object.parameter=value", where the
/// object is an id or a family that the scene has once ("integrator", "sensor", "film", "sampler",
/// "rfilter"). Replaces what the file says. Throws Error for an object that is not there.
void override_property(Description& description, const std::string& assignment);
/// The same for a change that comes from elsewhere than --set: `origin` is named if it is wrong.
void override_property(Description& description, const std::string& assignment,
                       const Place& origin);
void override_property(Description& description, const Setting& setting);
/// As --set gives it.
Setting setting_of_command_line(const std::string& assignment);

/// own_integrator(); the description gets the default one if it has none.
std::shared_ptr<Object> made_integrator(Description& description);

}  // namespace kaustik
