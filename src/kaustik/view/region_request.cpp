#include "kaustik/view/region_request.h"

#include <fmt/format.h>

#include "kaustik/view/request_error.h"

namespace kaustik::view {
namespace {

constexpr int64_t most_across = 1 << 20;  ///< pixels

int64_t number_of(const Json& json, const char* name, int64_t least, int64_t most) {
  const auto found = json.find(name);
  // Of large numbers alone those without a sign are told apart from others.
  const bool is_number = found != json.end() && found->is_number_integer() &&
                         (!found->is_number_unsigned() || found->get<uint64_t>() <= uint64_t(most));
  const int64_t value = is_number ? found->get<int64_t>() : least - 1;
  if (value < least || value > most)
    throw RequestError(
        400, fmt::format("the region's '{}' is no whole number from {} to {}", name, least, most),
        R"(give {"x": …, "y": …, "width": …, "height": …, "passes": 16})");
  return value;
}

}  // namespace

RegionRequest region_request_from(const Json& json) {
  if (!json.is_object())
    throw RequestError(400, "'refine' is no object",
                       R"(give {"x": …, "y": …, "width": …, "height": …, "passes": 16})");
  for (const auto& [name, value] : json.items())
    if (name != "x" && name != "y" && name != "width" && name != "height" && name != "passes")
      throw RequestError(400, fmt::format("'refine' takes no '{}'", name),
                         "it takes: x, y, width, height, passes");
  RegionRequest request;
  request.pixels = {int(number_of(json, "x", 0, most_across)),
                    int(number_of(json, "y", 0, most_across)),
                    int(number_of(json, "width", 1, most_across)),
                    int(number_of(json, "height", 1, most_across))};
  request.passes = uint32_t(number_of(json, "passes", 1, most_region_passes));
  return request;
}

Json json_of(const std::vector<RegionProgress>& regions) {
  Json list = Json::array();
  for (const RegionProgress& region : regions)
    list.push_back({{"x", region.pixels.x},
                    {"y", region.pixels.y},
                    {"width", region.pixels.width},
                    {"height", region.pixels.height},
                    {"passes", region.passes},
                    {"waiting", region.waiting}});
  return list;
}

}  // namespace kaustik::view
