#pragma once

namespace kaustik {

/// Null boundaries that a path is followed through without an event. There are more only on ways
/// that rounding never lets end, where boundaries meet in a point or a line.
inline constexpr int most_null_boundaries = 10'000;

}  // namespace kaustik
