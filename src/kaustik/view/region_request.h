#pragma once
#include "kaustik/render/session.h"
#include "kaustik/view/json_text.h"

namespace kaustik::view {

/// {"x", "y", "width", "height", "passes"}, all whole numbers. Throws RequestError.
RegionRequest region_request_from(const Json& json);
/// {"x", "y", "width", "height", "passes", "waiting"} of each.
Json json_of(const std::vector<RegionProgress>& regions);

}  // namespace kaustik::view
