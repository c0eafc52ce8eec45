#include "kaustik/view/json_text.h"

#include <fmt/format.h>

#include "kaustik/base/error.h"
#include "kaustik/view/request_error.h"

namespace kaustik::view {
namespace {

/// Of objects and arrays in one another; requests of the page have three.
constexpr int deepest_json = 8;

}  // namespace

Json parse_request_json(std::string_view text) {
  Json json;
  try {
    json = Json::parse(text, [](int depth, Json::parse_event_t, Json&) {
      if (depth > deepest_json)
        throw RequestError(400, fmt::format("JSON is nested more than {} deep", deepest_json),
                           "send a command as docs/reference/view_requests.md tells");
      return true;
    });
  } catch (const nlohmann::json::exception& error) {
    throw RequestError(400, fmt::format("the body is no JSON: {}", error.what()),
                       "send one JSON object");
  }
  if (!json.is_object()) throw RequestError(400, "the body is no JSON object", "send one: {…}");
  return json;
}

std::string text_of_json(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

HttpResponse json_response(const Json& json) {
  return {200, "application/json", {}, std::make_shared<const std::string>(text_of_json(json))};
}

HttpResponse response_of(const RequestError& error) {
  HttpResponse response = json_response(Json{{"error", error.what()}, {"remedy", error.remedy()}});
  response.status = error.status();
  return response;
}

HttpResponse response_of_current_exception() {
  try {
    throw;
  } catch (const RequestError& error) {
    return response_of(error);
  } catch (const Error& error) {
    const Problem& first = error.problems().front();
    const unsigned status = error.kind() == ErrorKind::input ? 400 : 500;
    return response_of(RequestError(status, first.message, first.remedy));
  } catch (const std::exception& error) {
    return response_of(RequestError(500, error.what(), "try again"));
  }
}

}  // namespace kaustik::view
