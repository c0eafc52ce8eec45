#include "kaustik/view/query.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "kaustik/view/request_error.h"

namespace kaustik::view {
namespace {

int hexadecimal(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// Without the escapes of a query.
std::string unescaped(std::string_view text) {
  std::string result;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      result += text[i] == '+' ? ' ' : text[i];
      continue;
    }
    const int high = i + 2 < text.size() ? hexadecimal(text[i + 1]) : -1;
    const int low = i + 2 < text.size() ? hexadecimal(text[i + 2]) : -1;
    if (high < 0 || low < 0)
      throw RequestError(400, "the query has a % that no two hexadecimal digits follow");
    result += char(high * 16 + low);
    i += 2;
  }
  return result;
}

}  // namespace

Query::Query(std::string_view target) {
  if (!target.starts_with('/'))
    throw RequestError(400, "the request's target is no path", "begin it with /");
  const size_t mark = std::min(target.find('?'), target.size());
  path_ = target.substr(0, mark);
  std::string_view rest = target.substr(std::min(target.size(), mark + 1));
  while (!rest.empty()) {
    const size_t end = std::min(rest.find('&'), rest.size());
    const std::string_view field = rest.substr(0, end);
    rest.remove_prefix(std::min(rest.size(), end + 1));
    if (field.empty()) continue;
    const size_t equals = std::min(field.find('='), field.size());
    fields_.emplace_back(unescaped(field.substr(0, equals)),
                         unescaped(field.substr(std::min(field.size(), equals + 1))));
  }
}

void Query::allow_only(const std::vector<std::string_view>& names) const {
  for (size_t i = 0; i < fields_.size(); ++i) {
    const std::string& name = fields_[i].first;
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw RequestError(
          400, fmt::format("'{}' takes no '{}'", path_, name),
          names.empty() ? "leave it out" : fmt::format("it takes: {}", fmt::join(names, ", ")));
    for (size_t j = 0; j < i; ++j)
      if (fields_[j].first == name)
        throw RequestError(400, fmt::format("'{}' is given twice", name), "give it once");
  }
}

const std::string* Query::find(std::string_view name) const {
  for (const auto& [key, value] : fields_)
    if (key == name) return &value;
  return nullptr;
}

std::optional<int64_t> Query::integer(std::string_view name, int64_t least, int64_t most) const {
  const std::string* text = find(name);
  if (!text) return std::nullopt;
  int64_t value = 0;
  const char* const last = text->data() + text->size();
  const auto [end, code] = std::from_chars(text->data(), last, value);
  if (code != std::errc{} || end != last || value < least || value > most)
    throw RequestError(400, fmt::format("'{}' is no whole number from {} to {}", name, least, most),
                       fmt::format("give such a number: {}={}", name, least));
  return value;
}

int64_t Query::required(std::string_view name, int64_t least, int64_t most) const {
  const auto value = integer(name, least, most);
  if (!value)
    throw RequestError(400, fmt::format("'{}' needs '{}'", path_, name),
                       fmt::format("add {}=…", name));
  return *value;
}

std::string Query::text(std::string_view name) const {
  const std::string* text = find(name);
  return text ? *text : std::string();
}

}  // namespace kaustik::view
