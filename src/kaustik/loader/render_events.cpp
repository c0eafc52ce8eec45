#include "kaustik/loader/render_events.h"

#include <cmath>
#include <filesystem>

#include "kaustik/base/text_lines.h"
#include "kaustik/loader/json_document.h"

namespace kaustik {
namespace {

double number_in(const JsonValue& event, const char* name) {
  const JsonValue* value = event.find(name);
  return value ? value->number().value_or(std::nan("")) : std::nan("");
}
int64_t count_in(const JsonValue& event, const char* name) {
  const double number = number_in(event, name);
  return number >= 0 && number < 9e15 ? int64_t(number) : 0;
}
std::string text_in(const JsonValue& event, const char* name) {
  const JsonValue* value = event.find(name);
  const std::string* text = value ? value->text() : nullptr;
  return text ? *text : "";
}

void take(const JsonValue& event, RenderEvents& events) {
  const std::string kind = text_in(event, "event");
  if (kind == "measured") {
    events.values.push_back(
        {Vec3d(number_in(event, "x"), number_in(event, "y"), number_in(event, "z")),
         number_in(event, "value"), number_in(event, "half_width"), text_in(event, "unit")});
  } else if (kind == "end") {
    events.exit_code = int(count_in(event, "exit_code"));
    events.passes = count_in(event, "passes");
    events.samples_per_pixel = count_in(event, "samples_per_pixel");
    events.seconds = number_in(event, "elapsed_s");
    if (events.values.empty() && event.find("mean"))
      events.values.push_back({std::nullopt, number_in(event, "mean"),
                               number_in(event, "mean_half_width"), text_in(event, "unit")});
  }
}

}  // namespace

std::optional<RenderEvents> read_render_events(const std::string& path) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(path, unknown)) return {};
  RenderEvents events;
  TextLines lines(path);
  for (std::string_view line; lines.next(line);) {
    try {
      take(parse_json(line), events);
    } catch (const BadJson&) {
      // The render may have been ended in the middle of a line.
    }
  }
  return events;
}

}  // namespace kaustik
