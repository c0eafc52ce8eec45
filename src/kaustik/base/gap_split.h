#pragma once
#include <optional>
#include <vector>

namespace kaustik {

/// A number that divides `places` into two parts as equal as may be, in a gap between them that is
/// wider than `least_gap`: points of one plane, which differ by rounding alone, stay together. None
/// if there is no such gap.
std::optional<float> split_in_gap(std::vector<float> places, float least_gap);

/// Such gaps, relative to the size of what is divided.
inline constexpr float least_relative_gap = 1e-5f;

}  // namespace kaustik
