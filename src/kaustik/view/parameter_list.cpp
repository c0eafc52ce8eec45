#include "kaustik/view/parameter_list.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "kaustik/integrator/description_types.h"
#include "kaustik/integrator/registry.h"
#include "kaustik/scene/scene.h"
#include "kaustik/view/scene_edits.h"

namespace kaustik::view {
namespace {

/// What a page calls the kind; "": it cannot show it.
std::string page_kind(ParameterKind kind) {
  switch (kind) {
    case ParameterKind::boolean:
      return "boolean";
    case ParameterKind::integer:
      return "integer";
    case ParameterKind::number:
      return "number";
    case ParameterKind::choice:
      return "choice";
    case ParameterKind::color:
      return "color";
    case ParameterKind::text:
    case ParameterKind::number_or_name:
      return "text";
    case ParameterKind::point:
    case ParameterKind::transform:
    case ParameterKind::file:
    case ParameterKind::array:
      return {};
  }
  return {};
}

std::optional<double> number_in(const std::string& text) {
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (end == text.c_str() || *end != 0 || !std::isfinite(number)) return std::nullopt;
  return number;
}

/// What --set or a page has given, as a value of that kind; null: nothing that can be shown.
Json json_of_text(const std::string& text, ParameterKind kind) {
  switch (kind) {
    case ParameterKind::boolean:
      return text == "true" || text == "1";
    case ParameterKind::integer:
    case ParameterKind::number: {
      const auto number = number_in(text);
      if (!number) return nullptr;
      return kind == ParameterKind::integer ? Json(int64_t(*number)) : Json(*number);
    }
    case ParameterKind::color: {
      std::vector<double> numbers;
      for (size_t begin = 0; begin < text.size();) {
        const size_t end = std::min(text.find_first_of(" ,\t", begin), text.size());
        if (end > begin)
          if (const auto number = number_in(text.substr(begin, end - begin)))
            numbers.push_back(*number);
        begin = end + 1;
      }
      if (numbers.size() == 1) numbers.resize(3, numbers[0]);
      return numbers.size() == 3 ? Json(numbers) : Json(nullptr);
    }
    default:
      return text;
  }
}

Json json_of_value(const Value& value, ParameterKind kind) {
  if (const auto* flag = std::get_if<bool>(&value)) return *flag;
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* rgb = std::get_if<Rgb>(&value)) return Json::array({rgb->r, rgb->g, rgb->b});
  if (const auto* untyped = std::get_if<Untyped>(&value)) return json_of_text(untyped->text, kind);
  std::optional<double> number;
  if (const auto* whole = std::get_if<int64_t>(&value)) number = double(*whole);
  if (const auto* real = std::get_if<double>(&value)) number = *real;
  if (!number) return nullptr;
  if (kind == ParameterKind::color) return Json::array({*number, *number, *number});
  if (kind == ParameterKind::integer) return int64_t(*number);
  return *number;
}

Json finite(double number) { return std::isfinite(number) ? Json(number) : Json(nullptr); }

/// One row; null where it is not shown.
Json row_of(const Object& object, const Parameter& row) {
  const std::string kind = page_kind(row.kind);
  const auto is_called = [&](const auto& held) { return held.name == row.name; };
  if (kind.empty() || row.no_effect || std::ranges::any_of(object.children, is_called))
    return nullptr;
  const Value* const usual = std::get_if<Value>(&row.default_value);
  const auto given = std::ranges::find_if(object.properties, is_called);
  const Json usual_json = usual ? json_of_value(*usual, row.kind) : Json(nullptr);
  const bool is_given = given != object.properties.end();
  return {{"name", row.name},
          {"kind", kind},
          {"value", is_given ? json_of_value(given->value, row.kind) : usual_json},
          {"default", usual_json},
          {"minimum", finite(row.minimum)},
          {"maximum", finite(row.maximum)},
          {"unit", row.unit},
          {"choices", row.choices},
          {"about", row.sentence}};
}

Json rows_of(const Object& object, const TypeInfo& info) {
  Json rows = Json::array();
  for (const Parameter& parameter : info.parameters)
    if (Json row = row_of(object, parameter); !row.is_null()) rows.push_back(std::move(row));
  return rows;
}

void add_object(Json& list, const std::string& name, const Object& object) {
  const TypeInfo* info = description_types().find(object.family, object.type);
  if (!info) return;
  Json rows = rows_of(object, *info);
  if (rows.empty()) return;
  list.push_back({{"id", name},
                  {"family", object.family},
                  {"type", object.type},
                  {"parameters", std::move(rows)}});
}

}  // namespace

std::string integrator_of(const Description& description) {
  const auto own = find_integrator(description);
  return own ? own->type : default_integrator;
}

Json parameter_list(const Description& description) {
  Json objects = Json::array();
  if (!find_integrator(description)) {
    Object usual;
    usual.family = "integrator";
    usual.type = default_integrator;
    add_object(objects, "integrator", usual);
  }
  for (const NamedObject& named : named_objects(description))
    add_object(objects, named.name, *named.object);
  Json integrators = Json::array();
  for (const IntegratorType& type : integrator_types()) integrators.push_back(type.info.name);
  return {{"objects", std::move(objects)}, {"integrators", std::move(integrators)}};
}

}  // namespace kaustik::view
