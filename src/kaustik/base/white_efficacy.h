#pragma once

namespace kaustik {

/// Lumens per watt of white light, the convention of lighting simulation (Radiance's WHTEFFICACY).
inline constexpr float white_efficacy = 179.0f;

}  // namespace kaustik
