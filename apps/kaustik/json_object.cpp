#include "json_object.h"

#include <fmt/format.h>

#include <cmath>

namespace kaustik::app {
namespace {

/// Length of the character of UTF-8 that begins here; 0: it is none.
size_t utf8_length(std::string_view text) {
  const auto byte = [&](size_t i) { return i < text.size() ? uint8_t(text[i]) : 0u; };
  const unsigned first = byte(0);
  const size_t length = first < 0x80                     ? 1
                        : first >= 0xC2 && first <= 0xDF ? 2
                        : first >= 0xE0 && first <= 0xEF ? 3
                        : first >= 0xF0 && first <= 0xF4 ? 4
                                                         : 0;
  for (size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xC0) != 0x80) return 0;
  // Too long for what they say, surrogates, and beyond U+10FFFF.
  if ((first == 0xE0 && byte(1) < 0xA0) || (first == 0xED && byte(1) > 0x9F) ||
      (first == 0xF0 && byte(1) < 0x90) || (first == 0xF4 && byte(1) > 0x8F))
    return 0;
  return length;
}

}  // namespace

std::string json_string(std::string_view text) {
  std::string result = "\"";
  while (!text.empty()) {
    const size_t length = utf8_length(text);
    const char c = text.front();
    if (length == 0)
      result += "\\ufffd";
    else if (c == '"' || c == '\\')
      result += {'\\', c};
    else if (c == '\n')
      result += "\\n";
    else if (uint8_t(c) < 0x20 || c == 0x7F)
      result += fmt::format("\\u{:04x}", uint8_t(c));
    else
      result += text.substr(0, length);
    text.remove_prefix(std::max<size_t>(1, length));
  }
  return result + "\"";
}

JsonObject& JsonObject::add_value(std::string_view name, std::string_view value) {
  if (!members_.empty()) members_ += ',';
  members_ += json_string(name);
  members_ += ':';
  members_ += value;
  return *this;
}

JsonObject& JsonObject::add(std::string_view name, std::string_view text) {
  return add_value(name, json_string(text));
}

JsonObject& JsonObject::add(std::string_view name, const std::vector<std::string>& texts) {
  std::string list;
  for (const std::string& text : texts) list += (list.empty() ? "" : ",") + json_string(text);
  return add_value(name, "[" + list + "]");
}

JsonObject& JsonObject::add(std::string_view name, double number) {
  return std::isfinite(number) ? add_value(name, fmt::format("{}", number)) : add_null(name);
}

JsonObject& JsonObject::add(std::string_view name, int64_t number) {
  return add_value(name, std::to_string(number));
}

JsonObject& JsonObject::add(std::string_view name, uint64_t number) {
  return add_value(name, std::to_string(number));
}

JsonObject& JsonObject::add(std::string_view name, bool flag) {
  return add_value(name, flag ? "true" : "false");
}

JsonObject& JsonObject::add(std::string_view name, const JsonObject& object) {
  return add_value(name, object.text());
}

JsonObject& JsonObject::add_null(std::string_view name) { return add_value(name, "null"); }

JsonObject& JsonObject::append(const JsonObject& other) {
  if (!members_.empty() && !other.members_.empty()) members_ += ',';
  members_ += other.members_;
  return *this;
}

}  // namespace kaustik::app
