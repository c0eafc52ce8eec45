#include "kaustik/loader/pbrt/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kaustik/base/to_integer.h"

namespace kaustik::pbrt {
namespace {

/// No object has as many as a tenth of that, and names are compared with one another.
constexpr size_t most_parameters = 500;

/// As files spell them, and as pbrt-v4 does.
struct TypeName {
  std::string_view written, meant;
};
constexpr TypeName type_names[] = {
    {"float", "float"},       {"integer", "integer"}, {"bool", "bool"},
    {"string", "string"},     {"point2", "point2"},   {"vector2", "vector2"},
    {"point3", "point3"},     {"point", "point3"},    {"vector3", "vector3"},
    {"vector", "vector3"},    {"normal", "normal"},   {"normal3", "normal"},
    {"rgb", "rgb"},           {"color", "rgb"},       {"blackbody", "blackbody"},
    {"spectrum", "spectrum"}, {"texture", "texture"}, {"xyz", "xyz"},
};

[[noreturn]] void refuse(std::string message, std::string remedy, Place place) {
  throw Error(ErrorKind::input, std::move(message), std::move(remedy), std::move(place));
}

std::string_view next_part(std::string_view& text) {
  constexpr std::string_view blanks = " \t";
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  const std::string_view part = text.substr(0, text.find_first_of(blanks));
  text.remove_prefix(part.size());
  return part;
}

bool holds_floats(std::string_view type) {
  return type == "point2" || type == "vector2" || type == "point3" || type == "vector3" ||
         type == "normal";
}

Parameter declared(const Token& declaration, const Place& place) {
  std::string_view rest = declaration.text;
  const std::string_view written = next_part(rest), name = next_part(rest);
  if (written.empty() || name.empty() || !next_part(rest).empty())
    refuse(fmt::format("{} is no type and name of a parameter", shown(declaration.text)),
           "write both, such as \"float radius\"", place);
  Parameter parameter;
  parameter.name = name;
  parameter.place = place;
  for (const TypeName& row : type_names)
    if (row.written == written) parameter.type = row.meant;
  if (parameter.type.empty()) {
    std::vector<std::string> known;
    for (const TypeName& row : type_names) known.emplace_back(row.written);
    refuse(fmt::format("{} is no type of a parameter", shown(written)),
           suggest(std::string(written.substr(0, 40)), known), place);
  }
  if (holds_floats(parameter.type)) parameter.floats = std::make_shared<std::vector<float>>();
  if (parameter.type == "integer") parameter.integers = std::make_shared<std::vector<int32_t>>();
  return parameter;
}

/// A string, or true and false. False: it is none of these.
bool take_text(const Token& token, Parameter& parameter) {
  if (token.kind == TokenKind::quoted) {
    if (parameter.type == "bool" && (token.text == "true" || token.text == "false"))
      parameter.flags.push_back(token.text == "true");
    else
      parameter.texts.push_back(unescaped(token.text));
    return true;
  }
  if (token.kind != TokenKind::word || (token.text != "true" && token.text != "false"))
    return false;
  parameter.flags.push_back(token.text == "true");
  return true;
}

void take_numbers_of(Tokenizer& tokens, Parameter& parameter) {
  if (parameter.floats)
    tokens.take_numbers(*parameter.floats);
  else if (parameter.integers)
    tokens.take_numbers(*parameter.integers);
  else
    tokens.take_numbers(parameter.numbers);
}

void take_value(Tokenizer& tokens, Parameter& parameter) {
  double number = 0;
  if (const Token& next = tokens.peek();
      next.kind == TokenKind::word && parse_number(next.text, number))
    return take_numbers_of(tokens, parameter);  // v3 allows several without brackets
  const Token token = tokens.next();
  if (!take_text(token, parameter))
    refuse(fmt::format("parameter {} has no value", shown(parameter.name)),
           "write a number, a string, true or false, or several in brackets",
           tokens.place_of(token));
}

void take_values(Tokenizer& tokens, Parameter& parameter) {
  const Token open = tokens.next();
  for (;;) {
    take_numbers_of(tokens, parameter);
    const Token token = tokens.next();
    if (token.kind == TokenKind::close) return;
    if (token.kind == TokenKind::end)
      refuse("the list of values does not end", "close it by a bracket", tokens.place_of(open));
    if (!take_text(token, parameter))
      refuse(fmt::format("{} is no value", shown(token.text)),
             "write numbers, strings, true or false", tokens.place_of(token));
  }
}

/// What a type takes.
void check_values(const Parameter& parameter) {
  const bool takes_texts = parameter.type == "string" || parameter.type == "texture";
  const bool takes_flags = parameter.type == "bool";
  const bool takes_numbers = !takes_texts && !takes_flags;
  const bool may_name = parameter.type == "spectrum";
  if ((parameter.number_count() > 0 && !takes_numbers) ||
      (!parameter.flags.empty() && !takes_flags) ||
      (!parameter.texts.empty() && !takes_texts && !may_name))
    refuse(fmt::format("parameter {} has values of another type than {}", shown(parameter.name),
                       shown(parameter.type)),
           takes_texts   ? "put them into quotes"
           : takes_flags ? "write true or false"
                         : "write numbers without quotes",
           parameter.place);
}

}  // namespace

bool is_same_name(std::string_view a, std::string_view b) {
  const auto small = [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; };
  return std::ranges::equal(a, b, [&](char x, char y) { return small(x) == small(y); });
}

ParameterList ParameterList::read(Tokenizer& tokens, const Place& place) {
  ParameterList list(place);
  while (tokens.peek().kind == TokenKind::quoted) {
    const Token declaration = tokens.next();
    Parameter parameter = declared(declaration, tokens.place_of(declaration));
    if (tokens.peek().kind == TokenKind::open)
      take_values(tokens, parameter);
    else
      take_value(tokens, parameter);
    check_values(parameter);
    if (list.all_.size() >= most_parameters)
      refuse(fmt::format("an object has more than {} parameters", most_parameters),
             "no object of pbrt has so many: take out those without effect", parameter.place);
    for (const Parameter& other : list.all_)
      if (other.name == parameter.name)
        refuse(fmt::format("parameter {} is given twice", shown(parameter.name)),
               keep_one(other.place), parameter.place);
    list.all_.push_back(std::move(parameter));
  }
  return list;
}

void ParameterList::add_defaults(const ParameterList& others) {
  const size_t own = all_.size();
  for (auto other = others.all_.rbegin(); other != others.all_.rend(); ++other) {
    const bool is_given = std::any_of(all_.begin(), all_.end(), [&](const Parameter& p) {
      return is_same_name(p.name, other->name);
    });
    if (is_given) continue;
    all_.push_back(*other);
    all_.back().is_used = true;  // that one has no use for it is no mistake
  }
  std::reverse(all_.begin() + std::ptrdiff_t(own), all_.end());
}

const Parameter* ParameterList::find(std::string_view name,
                                     std::initializer_list<std::string_view> types) const {
  for (const Parameter& parameter : all_) {
    if (!is_same_name(parameter.name, name)) continue;
    if (types.size() > 0 && std::find(types.begin(), types.end(), parameter.type) == types.end())
      continue;
    parameter.is_used = true;
    return &parameter;
  }
  return nullptr;
}

std::optional<double> ParameterList::number(std::string_view name) const {
  const Parameter* parameter = find(name, {"float", "integer"});
  if (!parameter || parameter->number_count() == 0) return std::nullopt;
  return parameter->number(0);
}

int ParameterList::integer(std::string_view name, int otherwise) const {
  constexpr int most = 1 << 30;
  const std::optional<double> given = number(name);
  return given ? to_integer(std::round(*given), -most, most) : otherwise;
}

bool ParameterList::flag(std::string_view name, bool otherwise) const {
  const Parameter* parameter = find(name, {"bool"});
  return parameter && !parameter->flags.empty() ? bool(parameter->flags.front()) : otherwise;
}

std::string ParameterList::text(std::string_view name, const std::string& otherwise) const {
  const Parameter* parameter = find(name, {"string"});
  return parameter && !parameter->texts.empty() ? parameter->texts.front() : otherwise;
}

std::optional<Vec3d> ParameterList::point(std::string_view name) const {
  const Parameter* parameter = find(name, {"point3", "vector3", "normal"});
  if (!parameter || parameter->number_count() < 3) return std::nullopt;
  return Vec3d(parameter->number(0), parameter->number(1), parameter->number(2));
}

std::vector<double> ParameterList::numbers(std::string_view name) const {
  const Parameter* parameter = find(name);
  if (!parameter) return {};
  std::vector<double> numbers;
  numbers.reserve(parameter->number_count());
  for (size_t i = 0; i < parameter->number_count(); ++i) numbers.push_back(parameter->number(i));
  return numbers;
}

Place ParameterList::place_of(std::string_view name) const {
  for (const Parameter& parameter : all_)
    if (is_same_name(parameter.name, name)) return parameter.place;
  return place_;
}

void ParameterList::accept(std::initializer_list<std::string_view> names) const {
  for (const std::string_view name : names) find(name);
}

void ParameterList::tell_unused(const std::string& object, Deviations& deviations) const {
  for (const Parameter& parameter : all_)
    if (!parameter.is_used)
      deviations.ignored(object, fmt::format("parameter {} has no effect", shown(parameter.name)),
                         parameter.place);
}

size_t ParameterList::bytes() const {
  size_t bytes = all_.size() * sizeof(Parameter);
  for (const Parameter& parameter : all_) {
    bytes += parameter.numbers.size() * sizeof(double) + parameter.flags.size() / 8;
    for (const std::string& text : parameter.texts) bytes += sizeof(text) + text.size();
  }
  return bytes;
}

}  // namespace kaustik::pbrt
