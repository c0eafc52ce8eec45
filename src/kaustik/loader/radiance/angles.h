#pragma once
#include <numbers>

namespace kaustik::radiance {

/// In radians.
inline constexpr double degree = std::numbers::pi / 180;

}  // namespace kaustik::radiance
