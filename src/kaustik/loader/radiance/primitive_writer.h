#pragma once
#include <fmt/format.h>

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

#include "kaustik/base/vec.h"
#include "kaustik/loader/radiance/statements.h"

namespace kaustik::radiance {

/// Writes primitives as Radiance's files have them.
class PrimitiveWriter {
 public:
  void add(std::string_view modifier, std::string_view type, std::string_view id,
           std::span<const double> reals) {
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
  void line(std::string_view text) { (text_ += text) += '\n'; }

  std::string take() { return std::move(text_); }

 private:
  static std::string quoted(std::string_view word) {
    const bool is_plain = !word.empty() && word.find_first_of(" \t\r\n#!") == word.npos;
    const char quote = word.find('"') == word.npos ? '"' : '\'';
    return is_plain && word[0] != '"' && word[0] != '\'' ? std::string(word)
                                                         : quote + std::string(word) + quote;
  }

  std::string text_;
};

}  // namespace kaustik::radiance
