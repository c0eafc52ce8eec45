#pragma once
#include <string>

#include "kaustik/scene/description.h"

namespace kaustik {

/// A change of a description from outside, see override_property().
struct Setting {
  std::string object;  ///< an id, or a family that the scene has once
  std::string parameter;
  std::string value;   ///< as text, which the parameter's table reads
  std::string origin;  ///< who asks for it, for messages: a place
  friend bool operator==(const Setting&, const Setting&) = default;
};

/// "object.parameter=value", and back. Throws Error(input), at `origin`, for other texts.
Setting setting_from(const std::string& assignment, const std::string& origin);
std::string assignment_of(const Setting& setting);

/// Changes a description from outside: the object is an id or a family that the scene has once
/// ("integrator", "sensor", "film", "sampler", "rfilter"). Replaces what the file says. A camera
/// that has no film or sampler gets one. Throws Error for another object that is not there; its
/// origin is named if the value is wrong. The crop window of a film of the file scales with its
/// size.
void override_property(Description& description, const Setting& setting);
/// The same of setting_from(assignment), whose origin is the assignment itself.
void override_property(Description& description, const std::string& assignment);
/// The same of a value whose type is known: the place is the property's.
void override_property(Description& description, const std::string& object, Property property);

/// Leaves one camera in the scene: the one with the id `name`, or the first where that is empty.
/// Those in shapes and in batches count like those at the top.
/// Returns a sentence that names the others; "": there are none. Throws Error(input) where there is
/// no such camera.
std::string choose_camera(Description& description, const std::string& name);

/// own_integrator(); the description gets the default one if it has none.
std::shared_ptr<Object> made_integrator(Description& description);

}  // namespace kaustik
