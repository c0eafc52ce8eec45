#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kaustik::app {

/// An object of JSON (RFC 8259) as one line, its members in the order in which they are added.
class JsonObject {
 public:
  JsonObject& add(std::string_view name, std::string_view text);
  JsonObject& add(std::string_view name, const char* text) {
    return add(name, std::string_view(text));
  }
  JsonObject& add(std::string_view name, const std::string& text) {
    return add(name, std::string_view(text));
  }
  JsonObject& add(std::string_view name, const std::vector<std::string>& texts);
  /// The shortest text that gives the number again; null if it is not finite.
  JsonObject& add(std::string_view name, double number);
  JsonObject& add(std::string_view name, int64_t number);
  JsonObject& add(std::string_view name, uint64_t number);
  JsonObject& add(std::string_view name, int number) { return add(name, int64_t(number)); }
  JsonObject& add(std::string_view name, uint32_t number) { return add(name, uint64_t(number)); }
  JsonObject& add(std::string_view name, bool flag);
  JsonObject& add(std::string_view name, const JsonObject& object);
  JsonObject& add_null(std::string_view name);
  /// All members of another one, behind these.
  JsonObject& append(const JsonObject& other);

  bool empty() const { return members_.empty(); }
  std::string text() const { return "{" + members_ + "}"; }

 private:
  JsonObject& add_value(std::string_view name, std::string_view value);
  std::string members_;
};

/// In quotation marks, with what JSON escapes; bytes that are no UTF-8 become U+FFFD.
std::string json_string(std::string_view text);

}  // namespace kaustik::app
