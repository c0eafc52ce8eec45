#include "kaustik/loader/json_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

namespace kaustik {
namespace {

/// Letters of a text, and how far they have been read.
class CountedLetters {
 public:
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;
  using iterator_category = std::input_iterator_tag;

  CountedLetters(const char* at, const char** read) : at_(at), read_(read) {}
  reference operator*() const { return *at_; }
  CountedLetters& operator++() {
    *read_ = ++at_;
    return *this;
  }
  CountedLetters operator++(int) {
    CountedLetters before = *this;
    ++*this;
    return before;
  }
  friend bool operator==(const CountedLetters& a, const CountedLetters& b) {
    return a.at_ == b.at_;
  }

 private:
  const char* at_;
  const char** read_;
};

/// Builds the value that the parser goes through.
class JsonBuilder {
 public:
  JsonBuilder(std::string_view text, const char** read) : text_(text), read_(read) {}

  bool null() { return add(nullptr, letters_read(1)); }
  bool boolean(bool value) { return add(value, letters_read(1)); }
  // Behind a number one letter more has been read.
  bool number_integer(int64_t value) { return add(double(value), letters_read(2)); }
  bool number_unsigned(uint64_t value) { return add(double(value), letters_read(2)); }
  bool number_float(double value, const std::string&) { return add(value, letters_read(2)); }
  bool string(std::string& value) { return add(std::move(value), letters_read(1)); }
  bool binary(std::vector<uint8_t>&) { return false; }
  bool key(std::string& name) {
    name_ = std::move(name);
    return true;
  }
  bool start_object(size_t) { return start(JsonValue::Members()); }
  bool start_array(size_t) { return start(JsonValue::Items()); }
  bool end_object() { return end(); }
  bool end_array() { return end(); }
  template <typename Exception>
  bool parse_error(size_t, const std::string&, const Exception&) {
    const size_t at = size_t(*read_ - text_.data());
    if (at >= text_.size()) throw BadJson("the JSON ends too early", at);
    throw BadJson("this is no JSON", letters_read(1));
  }

  JsonValue take() { return std::move(root_); }

 private:
  /// The offset of what was read `back` letters ago.
  size_t letters_read(size_t back) const {
    const size_t read = size_t(*read_ - text_.data());
    return read < back ? 0 : std::min(read - back, text_.size() - 1);
  }

  JsonValue* place_for(JsonValue value) {
    if (open_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    JsonValue::Content& parent = open_.back()->content();
    if (auto* items = std::get_if<JsonValue::Items>(&parent))
      return &items->emplace_back(std::move(value));
    return &std::get<JsonValue::Members>(parent)
                .emplace_back(std::move(name_), std::move(value))
                .second;
  }
  template <typename T>
  bool add(T content, size_t offset) {
    place_for(JsonValue(std::move(content), offset));
    return true;
  }
  template <typename T>
  bool start(T content) {
    const size_t offset = letters_read(1);
    if (open_.size() == most_json_levels)
      throw BadJson(fmt::format("the JSON nests more than {} levels deep", most_json_levels),
                    offset);
    // Parents stay where they are while a child is open: they get no other one meanwhile.
    open_.push_back(place_for(JsonValue(std::move(content), offset)));
    return true;
  }
  bool end() {
    open_.pop_back();
    return true;
  }

  std::string_view text_;
  const char** read_;
  JsonValue root_;
  std::vector<JsonValue*> open_;
  std::string name_;
};

}  // namespace

const JsonValue::Items& JsonValue::items() const {
  static const Items none;
  const auto* items = std::get_if<Items>(&content_);
  return items ? *items : none;
}

const JsonValue::Members& JsonValue::members() const {
  static const Members none;
  const auto* members = std::get_if<Members>(&content_);
  return members ? *members : none;
}

const JsonValue* JsonValue::find(std::string_view name) const {
  for (const auto& [key, value] : members())
    if (key == name) return &value;
  return nullptr;
}

JsonValue parse_json(std::string_view text) {
  if (text.empty()) throw BadJson("the JSON is empty", 0);
  const char* read = text.data();
  JsonBuilder builder(text, &read);
  nlohmann::json::sax_parse(CountedLetters(text.data(), &read),
                            CountedLetters(text.data() + text.size(), &read), &builder);
  return builder.take();
}

}  // namespace kaustik
