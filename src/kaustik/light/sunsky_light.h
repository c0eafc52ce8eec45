#pragma once
#include <optional>

#include "kaustik/light/light.h"

namespace kaustik {

/// Unit vectors to the sun.
struct SunPlace {
  Vec3d by_compass;  ///< +x is south, +y west, +z the zenith
  Vec3f in_world{0, 0, 0};
};
/// Of the emitters `sunsky`, `sky` and `sun`; other lights have none.
std::optional<SunPlace> sun_place(const Light& light);

}  // namespace kaustik
