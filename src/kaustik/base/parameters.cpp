#include "kaustik/base/parameters.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "kaustik/base/limits.h"
#include "kaustik/base/snake_case.h"

namespace kaustik {
namespace {

std::string lower(std::string text) {
  for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

template <typename Number>
std::optional<Number> parse_number(std::string_view text) {
  Number value{};
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::vector<double> parse_list(std::string_view text) {
  std::vector<double> values;
  while (!text.empty()) {
    const size_t start = text.find_first_not_of(" ,\t");
    if (start == std::string_view::npos) break;
    text.remove_prefix(start);
    const size_t end = std::min(text.find_first_of(" ,\t"), text.size());
    const auto value = parse_number<double>(text.substr(0, end));
    if (!value) return {};
    values.push_back(*value);
    text.remove_prefix(end);
  }
  return values;
}

/// Gives text from the command line the type that the table asks for; nullopt if it has no such
/// form.
std::optional<Value> typed(const std::string& text, ParameterKind kind) {
  switch (kind) {
    case ParameterKind::boolean:
      if (lower(text) == "true" || text == "1") return Value(true);
      if (lower(text) == "false" || text == "0") return Value(false);
      return std::nullopt;
    case ParameterKind::integer:
      if (const auto i = parse_number<int64_t>(text)) return Value(*i);
      return std::nullopt;
    case ParameterKind::number:
      if (const auto d = parse_number<double>(text)) return Value(*d);
      return std::nullopt;
    case ParameterKind::number_or_name:
      if (const auto d = parse_number<double>(text)) return Value(*d);
      return Value(text);
    case ParameterKind::text:
    case ParameterKind::choice:
    case ParameterKind::file:
      return Value(text);
    case ParameterKind::point:
    case ParameterKind::color: {
      const std::vector<double> list = parse_list(text);
      if (list.size() == 3 && kind == ParameterKind::point)
        return Value(Vec3d(list[0], list[1], list[2]));
      if (list.size() == 3) return Value(Rgb{list[0], list[1], list[2]});
      if (list.size() == 1 && kind == ParameterKind::color) return Value(list[0]);
      return std::nullopt;
    }
    case ParameterKind::transform:
    case ParameterKind::array:
      return std::nullopt;
  }
  return std::nullopt;
}

/// The value in the representation that Arguments hands out, or nullopt for a wrong type.
std::optional<Value> coerce(const Value& value, ParameterKind kind) {
  if (const auto* untyped = std::get_if<Untyped>(&value)) {
    const auto result = typed(untyped->text, kind);
    return result ? coerce(*result, kind) : std::nullopt;
  }
  const auto same = [&]<typename T>(const T*) -> std::optional<Value> {
    if (std::holds_alternative<T>(value)) return value;
    return std::nullopt;
  };
  switch (kind) {
    case ParameterKind::boolean:
      return same(static_cast<bool*>(nullptr));
    case ParameterKind::integer:
      return same(static_cast<int64_t*>(nullptr));
    case ParameterKind::number:
      if (const auto* i = std::get_if<int64_t>(&value)) return Value(double(*i));
      return same(static_cast<double*>(nullptr));
    case ParameterKind::text:
    case ParameterKind::file:
      return same(static_cast<std::string*>(nullptr));
    case ParameterKind::choice:
      if (const auto* text = std::get_if<std::string>(&value)) return Value(lower(*text));
      return std::nullopt;
    case ParameterKind::number_or_name:
      if (const auto* text = std::get_if<std::string>(&value)) return Value(lower(*text));
      return coerce(value, ParameterKind::number);
    case ParameterKind::point:
      return same(static_cast<Vec3d*>(nullptr));
    case ParameterKind::color:
      if (const auto* i = std::get_if<int64_t>(&value))
        return Value(Rgb{double(*i), double(*i), double(*i)});
      if (const auto* d = std::get_if<double>(&value)) return Value(Rgb{*d, *d, *d});
      if (std::holds_alternative<SpectralCurve>(value)) return value;
      return same(static_cast<Rgb*>(nullptr));
    case ParameterKind::transform:
      return same(static_cast<Transform*>(nullptr));
    case ParameterKind::array: {
      const auto* array = std::get_if<std::shared_ptr<const Array>>(&value);
      return array && *array ? std::optional(value) : std::nullopt;
    }
  }
  return std::nullopt;
}

std::vector<double> numbers_in(const Value& value) {
  if (const auto* i = std::get_if<int64_t>(&value)) return {double(*i)};
  if (const auto* d = std::get_if<double>(&value)) return {*d};
  if (const auto* v = std::get_if<Vec3d>(&value)) return {v->x, v->y, v->z};
  if (const auto* c = std::get_if<Rgb>(&value)) return {c->r, c->g, c->b};
  std::vector<double> values;
  if (const auto* s = std::get_if<SpectralCurve>(&value))
    for (const auto& [wavelength, v] : s->samples) values.push_back(v);
  return values;
}

/// The text of a value that has to be one of the choices; null if it is free.
const std::string* name_out_of_choices(const Parameter& parameter, const Value& value) {
  const bool restricted =
      parameter.kind == ParameterKind::choice || parameter.kind == ParameterKind::number_or_name;
  return restricted ? std::get_if<std::string>(&value) : nullptr;
}

/// Moves and magnifies by numbers that lengths can bear; so does its inverse, if there is one.
bool is_within_lengths(const Transform& transform) {
  const Transform inverse = transform.dimensions() == 3 ? transform.inverse() : Transform();
  double largest = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      largest = std::max({largest, std::fabs(transform.at(i, j)), std::fabs(transform.at(i, 3)),
                          std::fabs(inverse.at(i, j))});
  return largest <= largest_length;  // false for what is no number
}

/// The same of an array.
std::string complaint(const Parameter& parameter, const Array& array) {
  const std::vector<size_t>&wanted = parameter.extents, &found = array.extents();
  bool fits = wanted.empty() || wanted.size() == found.size();
  for (size_t i = 0; fits && i < wanted.size(); ++i) fits = wanted[i] == 0 || wanted[i] == found[i];
  if (!fits) return fmt::format("'{}' has the extents {}", parameter.name, extents_text(found));
  if (parameter.of_integers && !is_integer(array.type()))
    return fmt::format("'{}' holds {}", parameter.name, element_name(array.type()));
  return {};
}

/// What is wrong with a value of the right type; empty if nothing.
std::string complaint(const Parameter& parameter, const Value& value) {
  if (const auto* array = std::get_if<std::shared_ptr<const Array>>(&value))
    return complaint(parameter, **array);
  const auto* transform = std::get_if<Transform>(&value);
  if (transform && transform->dimensions() < parameter.least_dimensions)
    return fmt::format("'{}' flattens things", parameter.name);
  if (transform && !is_within_lengths(*transform))
    return fmt::format("'{}' moves, grows or shrinks things beyond what single floats carry",
                       parameter.name);
  for (const double number : numbers_in(value)) {
    if (!std::isfinite(number))
      return fmt::format("'{}' must be finite, found {}", parameter.name, number);
    if (number < parameter.minimum || number > parameter.maximum)
      return fmt::format("'{}' is {}, outside its range", parameter.name, number);
  }
  if (const std::string* name = name_out_of_choices(parameter, value))
    if (std::find(parameter.choices.begin(), parameter.choices.end(), *name) ==
        parameter.choices.end())
      return fmt::format("'{}' cannot be '{}'", parameter.name, *name);
  return {};
}

/// "from 0 to 1"; an end that no scene gets near to is left out.
std::string range_text(double minimum, double maximum) {
  constexpr double endless = 1e300;
  if (!(maximum < endless)) return fmt::format("of at least {}", minimum);
  if (!(minimum > -endless)) return fmt::format("of at most {}", maximum);
  return fmt::format("from {} to {}", minimum, maximum);
}

std::string remedy_for(const Parameter& parameter, const Value& value) {
  if (const std::string* name = name_out_of_choices(parameter, value))
    return suggest(*name, parameter.choices);
  const auto* transform = std::get_if<Transform>(&value);
  if (transform && transform->dimensions() < parameter.least_dimensions)
    return "give no factor of 0";
  if (transform)
    return fmt::format("keep its factors between {:g} and {:g}, and its distances below {:g} m",
                       smallest_length, largest_length, largest_length);
  if (parameter.kind == ParameterKind::array)
    return fmt::format("give an array {}", extents_text(parameter));
  return fmt::format("give a value {}{}{}", range_text(parameter.minimum, parameter.maximum),
                     parameter.unit.empty() ? "" : " ", parameter.unit);
}

Parameter row(std::string name, ParameterKind kind, std::variant<std::monostate, Value> value,
              std::string sentence) {
  Parameter parameter;
  parameter.name = std::move(name);
  parameter.kind = kind;
  parameter.default_value = std::move(value);
  parameter.sentence = std::move(sentence);
  return parameter;
}

/// What a slot holds while nothing was given and there is no default.
Value empty_value(ParameterKind kind) {
  switch (kind) {
    case ParameterKind::boolean:
      return false;
    case ParameterKind::integer:
      return int64_t{0};
    case ParameterKind::number:
    case ParameterKind::number_or_name:
      return 0.0;
    case ParameterKind::text:
    case ParameterKind::choice:
    case ParameterKind::file:
      return std::string();
    case ParameterKind::point:
      return Vec3d(0, 0, 0);
    case ParameterKind::color:
      return Rgb{};
    case ParameterKind::transform:
      return Transform();
    case ParameterKind::array:
      return std::shared_ptr<const Array>();
  }
  return false;
}

}  // namespace

Parameter boolean_parameter(std::string name, bool value, std::string sentence) {
  return row(std::move(name), ParameterKind::boolean, Value(value), std::move(sentence));
}
Parameter integer_parameter(std::string name, int64_t value, std::string sentence) {
  return row(std::move(name), ParameterKind::integer, Value(value), std::move(sentence));
}
Parameter number_parameter(std::string name, double value, std::string sentence) {
  return row(std::move(name), ParameterKind::number, Value(value), std::move(sentence));
}
Parameter text_parameter(std::string name, std::string value, std::string sentence) {
  return row(std::move(name), ParameterKind::text, Value(std::move(value)), std::move(sentence));
}
Parameter choice_parameter(std::string name, std::string value, std::vector<std::string> choices,
                           std::string sentence) {
  Parameter p =
      row(std::move(name), ParameterKind::choice, Value(std::move(value)), std::move(sentence));
  p.choices = std::move(choices);
  return p;
}
Parameter number_or_name_parameter(std::string name, Value default_value,
                                   std::vector<std::string> names, std::string sentence) {
  Parameter p = row(std::move(name), ParameterKind::number_or_name, std::move(default_value),
                    std::move(sentence));
  p.choices = std::move(names);
  return p;
}
Parameter point_parameter(std::string name, Vec3d value, std::string sentence) {
  return row(std::move(name), ParameterKind::point, Value(value), std::move(sentence))
      .range(-largest_length, largest_length);
}
Parameter color_parameter(std::string name, double value, std::string sentence) {
  return row(std::move(name), ParameterKind::color, Value(Rgb{value, value, value}),
             std::move(sentence))
      .range(0, std::numeric_limits<double>::max());
}
Parameter transform_parameter(std::string name, std::string sentence) {
  return row(std::move(name), ParameterKind::transform, Value(Transform()), std::move(sentence));
}
Parameter to_world_parameter(std::string sentence) {
  return transform_parameter("to_world", std::move(sentence)).moved(WhenMoved::composed);
}
Parameter array_parameter(std::string name, std::vector<size_t> extents, std::string sentence) {
  Parameter p = row(std::move(name), ParameterKind::array, std::monostate{}, std::move(sentence));
  p.extents = std::move(extents);
  return p;
}
Parameter file_parameter(std::string name, std::string sentence) {
  return required(row(std::move(name), ParameterKind::file, std::monostate{}, std::move(sentence)));
}
Parameter ignored_parameter(std::string name, ParameterKind kind) {
  Parameter p = row(std::move(name), kind, std::monostate{}, "Accepted, no effect.");
  p.no_effect = true;
  return p;
}
Parameter optional(Parameter parameter) {
  parameter.default_value = std::monostate{};
  parameter.required = false;
  return parameter;
}
Parameter required(Parameter parameter) {
  parameter.default_value = std::monostate{};
  parameter.required = true;
  return parameter;
}

const Parameter* TypeInfo::find(std::string_view parameter_name) const {
  for (const Parameter& parameter : parameters)
    if (parameter.name == parameter_name) return &parameter;
  return nullptr;
}

std::vector<std::string> TypeInfo::parameter_names() const {
  std::vector<std::string> names;
  for (const Parameter& parameter : parameters) names.push_back(parameter.name);
  return names;
}

std::vector<Property> UnknownParameters::without_unknown(const TypeInfo& info,
                                                         const std::vector<Property>& properties) {
  std::vector<Property> known;
  const auto has = [&](const std::string& name) {
    const auto is_it = [&](const Property& property) { return property.name == name; };
    return std::any_of(properties.begin(), properties.end(), is_it) ||
           std::any_of(known.begin(), known.end(), is_it);
  };
  for (const Property& property : properties) {
    const bool is_of_file = property.place.file && property.place.line > 0;
    if (info.find(property.name) || !is_of_file) {
      known.push_back(property);
      continue;
    }
    const std::string snake = snake_case_from_camel_case(property.name);
    if (info.find(snake) && !has(snake)) {
      add(fmt::format("'{}' of {} '{}' is taken as '{}'", property.name, info.family, info.name,
                      snake),
          property.place);
      known.push_back({snake, property.value, property.place, property.name});
      continue;
    }
    add(fmt::format("{} '{}' has no parameter '{}': it is left out", info.family, info.name,
                    property.spelling()),
        property.place, nearest_name(property.name, info.parameter_names()));
  }
  return known;
}

void UnknownParameters::add(const std::string& text, const Place& place,
                            const std::string& nearest) {
  Found& found = found_[text];
  if (found.count++ > 0) return;
  found.first = place;
  found.nearest = nearest;
}

std::vector<std::string> UnknownParameters::warnings() const {
  std::vector<std::string> sentences;
  for (const auto& [text, found] : found_)
    sentences.push_back(fmt::format(
        "{}: {}{}{}", text_of(found.first), text,
        found.count > 1 ? fmt::format(", and {} more like it", found.count - 1) : "",
        found.nearest.empty() ? "" : fmt::format("; did you mean '{}'?", found.nearest)));
  return sentences;
}

Arguments::Arguments(const TypeInfo& info, const std::vector<Property>& given, const Place& place,
                     Problems& problems)
    : info_(&info), place_(place) {
  for (const Parameter& parameter : info.parameters) {
    const auto* value = std::get_if<Value>(&parameter.default_value);
    const auto coerced = value ? coerce(*value, parameter.kind) : std::nullopt;
    slots_.push_back(
        {coerced ? *coerced : empty_value(parameter.kind), value != nullptr, false, {}});
  }
  for (const Property& property : given) accept(property, problems);
  check_stand_ins(problems);
  for (size_t i = 0; i < slots_.size(); ++i) {
    const Parameter& parameter = info.parameters[i];
    if (parameter.required && !slots_[i].given && !stand_in_of(parameter))
      problems.add(fmt::format("{} '{}' needs '{}'", info.family, info.name, parameter.name),
                   parameter.sentence, place);
  }
}

void Arguments::check_stand_ins(Problems& problems) const {
  for (const Parameter& parameter : info_->parameters)
    if (const Parameter* other = stand_in_of(parameter); other && slot(parameter.name).given)
      problems.add(fmt::format("{} '{}' has both '{}' and '{}'", info_->family, info_->name,
                               other->name, parameter.name),
                   "give one of them", place_of(other->name));
}

const Parameter* Arguments::stand_in_of(const Parameter& parameter) const {
  for (size_t i = 0; i < slots_.size(); ++i)
    if (slots_[i].given && info_->parameters[i].stands_for == parameter.name)
      return &info_->parameters[i];
  return nullptr;
}

bool Arguments::is_complete() const {
  for (size_t i = 0; i < slots_.size(); ++i) {
    const Parameter& parameter = info_->parameters[i];
    if (!parameter.required || slots_[i].present) continue;
    const Parameter* other = stand_in_of(parameter);
    if (!other || !slot(other->name).present) return false;
  }
  return true;
}

void Arguments::accept(const Property& property, Problems& problems) {
  const Parameter* parameter = info_->find(property.name);
  if (!parameter) {
    problems.add(fmt::format("{} '{}' has no parameter '{}'", info_->family, info_->name,
                             property.spelling()),
                 info_->parameters.empty() ? "remove it: it takes none"
                                           : suggest(property.name, info_->parameter_names()),
                 property.place);
    return;
  }
  Slot& slot = slots_[size_t(parameter - info_->parameters.data())];
  if (slot.given) {
    problems.add(fmt::format("'{}' is given twice", property.spelling()), keep_one(slot.place),
                 property.place);
    return;
  }
  slot.given = true;
  slot.place = property.place;
  if (parameter->no_effect) {
    ignored_.push_back(property);
    return;
  }
  const auto value = coerce(property.value, parameter->kind);
  if (!value) {
    problems.add(fmt::format("'{}' has the wrong type", property.spelling()),
                 fmt::format("give it as {}: {}", kind_name(parameter->kind), parameter->sentence),
                 property.place);
    return;
  }
  if (const std::string wrong = complaint(*parameter, *value); !wrong.empty()) {
    problems.add(wrong, remedy_for(*parameter, *value), property.place);
    return;
  }
  slot.value = *value;
  slot.present = true;
}

const Arguments::Slot& Arguments::slot(std::string_view name) const {
  const Parameter* parameter = info_->find(name);
  if (!parameter)
    throw std::logic_error(
        fmt::format("the table of {} '{}' has no row '{}'", info_->family, info_->name, name));
  return slots_[size_t(parameter - info_->parameters.data())];
}

bool Arguments::has(std::string_view name) const { return slot(name).present; }
bool Arguments::given(std::string_view name) const { return slot(name).given; }
Place Arguments::place_of(std::string_view name) const {
  const Slot& s = slot(name);
  return s.given ? s.place : place_;
}
bool Arguments::boolean(std::string_view name) const { return std::get<bool>(slot(name).value); }
int64_t Arguments::integer(std::string_view name) const {
  return std::get<int64_t>(slot(name).value);
}
double Arguments::number(std::string_view name) const { return std::get<double>(slot(name).value); }
const std::string& Arguments::text(std::string_view name) const {
  return std::get<std::string>(slot(name).value);
}
std::variant<double, std::string> Arguments::number_or_name(std::string_view name) const {
  const Value& value = slot(name).value;
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  return std::get<double>(value);
}
Vec3d Arguments::point(std::string_view name) const { return std::get<Vec3d>(slot(name).value); }
std::variant<Rgb, SpectralCurve> Arguments::color(std::string_view name) const {
  const Value& value = slot(name).value;
  if (const auto* curve = std::get_if<SpectralCurve>(&value)) return *curve;
  return std::get<Rgb>(value);
}
const Transform& Arguments::transform(std::string_view name) const {
  return std::get<Transform>(slot(name).value);
}
const std::shared_ptr<const Array>& Arguments::array(std::string_view name) const {
  return std::get<std::shared_ptr<const Array>>(slot(name).value);
}

std::string name_and_place(const Property& property, const std::string& object) {
  const std::string name = fmt::format("'{}' of {}", property.spelling(), object);
  if (property.place.line == 0) return name;
  return fmt::format("{} ({})", name, text_of(property.place));
}

std::string without_effect(const std::vector<std::string>& names) {
  return fmt::format("without effect here: {}", fmt::join(names, ", "));
}

std::string kind_name(ParameterKind kind) {
  switch (kind) {
    case ParameterKind::boolean:
      return "boolean";
    case ParameterKind::integer:
      return "integer";
    case ParameterKind::number:
      return "float";
    case ParameterKind::text:
      return "string";
    case ParameterKind::choice:
      return "choice";
    case ParameterKind::number_or_name:
      return "float or name (string)";
    case ParameterKind::point:
      return "point or vector";
    case ParameterKind::color:
      return "rgb or spectrum";
    case ParameterKind::transform:
      return "transform";
    case ParameterKind::file:
      return "file name (string)";
    case ParameterKind::array:
      return "array";
  }
  return "value";
}

std::string extents_text(const Parameter& parameter) {
  std::vector<std::string> extents;
  for (const size_t extent : parameter.extents)
    extents.push_back(extent > 0 ? std::to_string(extent) : extents.empty() ? "n" : "m");
  std::string text = extents.empty() ? "" : fmt::format("[{}]", fmt::join(extents, ", "));
  if (parameter.of_integers) text += text.empty() ? "of integers" : " of integers";
  return text;
}

std::string default_text(const Parameter& parameter) {
  const auto* value = std::get_if<Value>(&parameter.default_value);
  if (!value) return {};
  if (const auto* b = std::get_if<bool>(value)) return *b ? "true" : "false";
  if (const auto* i = std::get_if<int64_t>(value)) return fmt::format("{}", *i);
  if (const auto* d = std::get_if<double>(value)) return fmt::format("{}", *d);
  if (const auto* s = std::get_if<std::string>(value)) return *s;
  if (const auto* v = std::get_if<Vec3d>(value)) return fmt::format("{}, {}, {}", v->x, v->y, v->z);
  if (const auto* c = std::get_if<Rgb>(value)) {
    if (c->r == c->g && c->g == c->b) return fmt::format("{}", c->r);
    return fmt::format("{}, {}, {}", c->r, c->g, c->b);
  }
  if (std::holds_alternative<Transform>(*value)) return "identity";
  return {};
}

}  // namespace kaustik
