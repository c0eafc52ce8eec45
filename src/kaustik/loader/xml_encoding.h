#pragma once
#include <string_view>

#include "kaustik/loader/text_places.h"

namespace kaustik {

/// Throws Error(input) unless the text, without a byte order mark, is UTF-8 (RFC 3629) and holds no
/// zero byte.
void check_encoding(std::string_view text, const TextPlaces& places);

}  // namespace kaustik
