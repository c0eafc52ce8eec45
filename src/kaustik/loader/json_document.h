#pragma once
// JSON texts whose values know where they stand, for messages.

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace kaustik {

/// A value of a JSON text.
class JsonValue {
 public:
  using Items = std::vector<JsonValue>;
  using Members = std::vector<std::pair<std::string, JsonValue>>;
  using Content = std::variant<std::nullptr_t, bool, double, std::string, Items, Members>;

  JsonValue() = default;
  JsonValue(Content content, size_t offset) : content_(std::move(content)), offset_(offset) {}

  /// In the text: of the first letter of an object or a list, of the last one of others.
  size_t offset() const { return offset_; }
  bool is_object() const { return std::holds_alternative<Members>(content_); }
  bool is_list() const { return std::holds_alternative<Items>(content_); }
  /// Null: it is no text.
  const std::string* text() const { return std::get_if<std::string>(&content_); }
  std::optional<double> number() const { return copy_of<double>(); }
  std::optional<bool> boolean() const { return copy_of<bool>(); }
  /// Of a list; none of others.
  const Items& items() const;
  /// Of an object; none of others.
  const Members& members() const;
  /// The member of that name, the first if there are several; null: there is none, or it is no
  /// object.
  const JsonValue* find(std::string_view name) const;

  Content& content() { return content_; }

 private:
  template <typename T>
  std::optional<T> copy_of() const {
    const T* found = std::get_if<T>(&content_);
    return found ? std::optional<T>(*found) : std::nullopt;
  }

  Content content_ = nullptr;
  size_t offset_ = 0;
};

/// What parse_json() throws for what is no JSON: a sentence, and where in the text.
struct BadJson : std::runtime_error {
  BadJson(const std::string& sentence, size_t at) : std::runtime_error(sentence), offset(at) {}
  size_t offset;
};

/// Lists and objects nest at most so deep.
inline constexpr size_t most_json_levels = 100;

/// The value that a text consists of. Numbers are finite. Takes time in proportion to the text, and
/// less than a hundred times its memory.
JsonValue parse_json(std::string_view text);

}  // namespace kaustik
