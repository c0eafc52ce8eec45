#pragma once
// The room's one way to read and write JSON.

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "kaustik/view/http_message.h"

namespace kaustik::view {

using Json = nlohmann::ordered_json;

/// Throws RequestError for what is no JSON, is nested deeper than requests are, or is no object.
Json parse_request_json(std::string_view text);
/// As one line; bytes that are no UTF-8 become U+FFFD, numbers that are not finite null.
std::string text_of_json(const Json& json);
HttpResponse json_response(const Json& json);

}  // namespace kaustik::view
