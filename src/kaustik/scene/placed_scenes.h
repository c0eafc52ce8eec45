#pragma once
#include <string>
#include <vector>

#include "kaustik/scene/description.h"

namespace kaustik {

/// An equal description in which groups hold nothing but shapes that do not shine. The groups of
/// `description` may be whole scenes: with instances of other groups, to any depth, with shapes
/// that shine and with lamps. Each placement of such a group becomes an instance of its dark
/// shapes, which all placements share, a copy of each lamp and shining shape where it comes to
/// stand, and placements of the groups in it. What a placed scene cannot bring with it (its camera,
/// its integrator) goes to `warnings`. Throws Error for more than 64 levels or a million
/// placements, and for lights of the whole world in a group.
Description flatten_placed_scenes(const Description& description,
                                  std::vector<std::string>& warnings);

}  // namespace kaustik
