#pragma once
#include <cstdint>
#include <span>
#include <string>

namespace kaustik {

/// The bytes in base 64 (RFC 4648, section 4), padded with '=', without line breaks.
std::string base64(std::span<const uint8_t> bytes);

}  // namespace kaustik
