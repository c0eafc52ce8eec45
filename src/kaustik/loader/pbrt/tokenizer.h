#pragma once
// pbrt's words: directives, quoted strings, brackets and numbers, in the text itself.

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "kaustik/base/error.h"

namespace kaustik::pbrt {

/// A text that stays where it is while a scene is read: what is made of it refers to its letters.
struct SourceText {
  std::shared_ptr<const std::string> name;  ///< for places
  std::string_view text;
  std::shared_ptr<const void> owner;  ///< keeps the letters
};

enum class TokenKind : uint8_t { end, word, quoted, open, close };

struct Token {
  TokenKind kind = TokenKind::end;
  std::string_view text;  ///< of quoted ones what is between the quotes, as it is written
  int line = 1, column = 1;
};

/// Hands out the tokens of a text, one after the other.
class Tokenizer {
 public:
  explicit Tokenizer(const SourceText& source);

  /// Throws Error(input) for a string that does not end on its line.
  Token next();
  const Token& peek();
  Place place_of(const Token& token) const;
  const SourceText& source() const { return source_; }

  /// Takes the numbers that come next, up to what is none. Throws Error(input) for a word that
  /// begins as a number and is none.
  template <typename Number>
  void take_numbers(std::vector<Number>& numbers);

 private:
  Token scan();
  void skip_blanks();

  const SourceText& source_;
  const char* at_;
  const char* end_;
  const char* line_start_;
  const char* next_close_;  ///< the closing bracket that was found last
  int line_ = 1;
  Token peeked_;
  bool has_peeked_ = false;
};

/// The number that a word is. False: it is none, or beyond all numbers.
bool parse_number(std::string_view word, double& number);

/// With the escapes that pbrt knows resolved: \n, \t, \\, \" and the like.
std::string unescaped(std::string_view quoted);

/// In quotes for messages; long ones are cut, odd letters replaced.
std::string shown(std::string_view text);

}  // namespace kaustik::pbrt
