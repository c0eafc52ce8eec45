#include "study_table.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <iterator>
#include <optional>

#include "kaustik/base/file.h"

namespace kaustik::app {
namespace {

/// As RFC 4180 has it.
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}
std::string cell(double number) {
  return std::isfinite(number) ? fmt::format("{:.9g}", number) : "";
}

void add_rows(const StudyPart& part, const RenderEvents& events, std::string& text) {
  std::string factors;
  for (const std::string& label : part.labels) factors += cell(label) + ",";
  for (const ToldValue& told : events.values) {
    const Vec3d nowhere(std::nan("")), at = told.position.value_or(nowhere);
    fmt::format_to(std::back_inserter(text), "{},{}{},{},{},{},{},{},{},{},{}\n", cell(part.name),
                   factors, cell(at.x), cell(at.y), cell(at.z), cell(told.value),
                   cell(told.half_width), cell(told.unit), events.passes, events.samples_per_pixel,
                   cell(events.seconds));
  }
}

}  // namespace

namespace {

/// Whether it was rendered by this very command.
bool has_its_command(const Study& study, const StudyPart& part) {
  const std::string file = command_file(study, part), command = part.command + "\n";
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(file, unknown)) return false;
  const std::vector<uint8_t> bytes = read_file_start(file, command.size() + 1);
  return std::equal(bytes.begin(), bytes.end(), command.begin(), command.end());
}

}  // namespace

std::optional<RenderEvents> result_of(const Study& study, const StudyPart& part) {
  if (!has_its_command(study, part)) return {};
  std::optional<RenderEvents> events = read_render_events(events_file(study, part));
  if (!events || events->exit_code != 0 || events->values.empty()) return {};
  return events;
}

StudyTable table_of(const Study& study, const std::vector<StudyPart>& parts) {
  StudyTable table;
  table.text = "part,";
  for (const StudyFactor& factor : study.factors) table.text += cell(factor.label) + ",";
  table.text += "x,y,z,value,half_width,unit,passes,samples_per_pixel,seconds\n";
  for (const StudyPart& part : parts) {
    if (const auto events = result_of(study, part))
      add_rows(part, *events, table.text);
    else
      table.missing.push_back(part.name);
  }
  return table;
}

}  // namespace kaustik::app
