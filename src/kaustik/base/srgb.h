#pragma once

namespace kaustik {

/// The transfer curve of IEC 61966-2-1 and its inverse. Odd functions, so that negative values
/// survive; not clamped above 1.
float srgb_from_linear(float linear);
float linear_from_srgb(float encoded);

}  // namespace kaustik
