#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "kaustik/base/place.h"

namespace kaustik {

/// Whether a file that begins with these bytes is packed.
bool is_gzip(std::span<const uint8_t> bytes);

/// What the bytes hold: themselves, or what gzip has packed into them. At most `most` bytes, and
/// one more where there are more. Throws Error(input) at `where` for packed data that are damaged,
/// incomplete, or grow out of all proportion.
std::vector<uint8_t> unpacked(std::vector<uint8_t> bytes, size_t most, const Place& where);

/// The same of the start of a file, as far as it can be unpacked.
std::vector<uint8_t> unpacked_start(std::span<const uint8_t> bytes, size_t most);

/// XML, meshes of text and the like are packed to a tenth or a twentieth. Small files may grow
/// beyond that.
inline constexpr size_t usual_growth = 30, always_allowed_growth = size_t{64} << 20;

}  // namespace kaustik
