#pragma once
#include "kaustik/scene/description.h"

namespace kaustik {

/// The arguments of an object that scene_types() has, by itself: what its table does not know is
/// left out. Throws Error(input) for what is wrong with the others.
Arguments arguments_alone(const Object& object);

}  // namespace kaustik
