#pragma once
#include <fmt/format.h>

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

#include "kaustik/base/error.h"
#include "kaustik/base/vec.h"
#include "kaustik/loader/radiance/statements.h"

namespace kaustik::radiance {

/// Writes primitives as Radiance's files have them. A short command may ask for many with long
/// names, so more than `most_bytes` throw Error(input).
class PrimitiveWriter {
 public:
  static constexpr size_t most_bytes = size_t{32} << 20;

  /// `place`: of the command.
  explicit PrimitiveWriter(Place place) : place_(std::move(place)) {}

  void add(std::string_view modifier, std::string_view type, std::string_view id,
           std::span<const double> reals) {
    need(modifier.size() + id.size() + most_digits * reals.size());
    text_ += fmt::format("{} {} {}\n0\n0\n{}", quoted(modifier), type, quoted(id), reals.size());
    for (const double number : reals) text_ += fmt::format(" {}", number);
    text_ += '\n';
  }
  void add(std::string_view modifier, std::string_view type, std::string_view id,
           std::initializer_list<double> reals) {
    add(modifier, type, id, std::span(reals.begin(), reals.size()));
  }
  void polygon(std::string_view modifier, std::string_view id, std::span<const Vec3d> corners) {
    std::vector<double> reals;
    for (const Vec3d& p : corners) reals.insert(reals.end(), {p.x, p.y, p.z});
    add(modifier, "polygon", id, reals);
  }
  void add(const Primitive& primitive) {
    need(primitive.modifier.size() + primitive.id.size() + most_digits * primitive.reals.size());
    if (primitive.type == "alias") {
      text_ += fmt::format("{} alias {} {}\n", quoted(primitive.modifier), quoted(primitive.id),
                           quoted(primitive.strings.at(0)));
      return;
    }
    text_ += fmt::format("{} {} {}\n{}", quoted(primitive.modifier), primitive.type,
                         quoted(primitive.id), primitive.strings.size());
    for (const std::string& word : primitive.strings) text_ += " " + quoted(word);
    text_ += fmt::format("\n0\n{}", primitive.reals.size());
    for (const double number : primitive.reals) text_ += fmt::format(" {}", number);
    text_ += '\n';
  }
  void line(std::string_view text) {
    need(text.size());
    (text_ += text) += '\n';
  }

  std::string take() { return std::move(text_); }

 private:
  static constexpr size_t most_digits = 25;  ///< of a number, and the blank before it

  void need(size_t bytes) const {
    if (text_.size() + bytes > most_bytes)
      throw Error(ErrorKind::input,
                  fmt::format("the command writes more than {} MiB", most_bytes >> 20),
                  "ask for fewer parts, or give them shorter names", place_);
  }
  static std::string quoted(std::string_view word) {
    const bool is_plain = !word.empty() && word.find_first_of(" \t\r\n#!") == word.npos;
    const char quote = word.find('"') == word.npos ? '"' : '\'';
    return is_plain && word[0] != '"' && word[0] != '\'' ? std::string(word)
                                                         : quote + std::string(word) + quote;
  }

  Place place_;
  std::string text_;
};

}  // namespace kaustik::radiance
