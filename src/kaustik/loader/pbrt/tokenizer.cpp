#include "kaustik/loader/pbrt/tokenizer.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "kaustik/base/decimal.h"
#include "kaustik/base/memory.h"
#include "kaustik/base/to_integer.h"

namespace kaustik::pbrt {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f'; }

/// Behind these a word ends.
bool ends_word(char c) { return is_space(c) || c == '"' || c == '[' || c == ']' || c == '#'; }

/// Integers beyond their range are its ends.
template <typename Number>
Number converted(double number) {
  if constexpr (std::is_integral_v<Number>)
    return to_integer(number, std::numeric_limits<Number>::min(),
                      std::numeric_limits<Number>::max());
  else
    return Number(number);
}

bool begins_number(char c) { return (c >= '0' && c <= '9') || c == '-' || c == '.' || c == '+'; }

}  // namespace

Tokenizer::Tokenizer(const SourceText& source)
    : source_(source),
      at_(source.text.data()),
      end_(source.text.data() + source.text.size()),
      line_start_(at_),
      next_close_(at_) {
  if (source.text.starts_with("\xef\xbb\xbf")) line_start_ = at_ += 3;
}

void Tokenizer::skip_blanks() {
  for (; at_ != end_; ++at_) {
    if (*at_ == '\n') {
      ++line_;
      line_start_ = at_ + 1;
    } else if (*at_ == '#') {
      while (at_ + 1 != end_ && at_[1] != '\n') ++at_;
    } else if (!is_space(*at_)) {
      return;
    }
  }
}

Token Tokenizer::scan() {
  skip_blanks();
  Token token{TokenKind::end, {}, line_, int(at_ - line_start_) + 1};
  if (at_ == end_) return token;
  const char* const first = at_;
  if (*at_ == '[' || *at_ == ']') {
    token.kind = *at_ == '[' ? TokenKind::open : TokenKind::close;
    token.text = {at_++, 1};
  } else if (*at_ == '"') {
    token.kind = TokenKind::quoted;
    for (++at_; at_ != end_ && *at_ != '"' && *at_ != '\n'; ++at_)
      if (*at_ == '\\' && at_ + 1 != end_ && at_[1] != '\n') ++at_;
    if (at_ == end_ || *at_ != '"')
      throw Error(ErrorKind::input, "the string does not end on its line",
                  "close it by a quotation mark", place_of(token));
    token.text = {first + 1, size_t(at_ - first - 1)};
    ++at_;
  } else {
    token.kind = TokenKind::word;
    while (at_ != end_ && !ends_word(*at_)) ++at_;
    token.text = {first, size_t(at_ - first)};
  }
  return token;
}

Token Tokenizer::next() {
  if (!has_peeked_) return scan();
  has_peeked_ = false;
  return peeked_;
}

const Token& Tokenizer::peek() {
  if (!has_peeked_) peeked_ = scan();
  has_peeked_ = true;
  return peeked_;
}

Place Tokenizer::place_of(const Token& token) const {
  return {source_.name, token.line, token.column};
}

template <typename Number>
void Tokenizer::take_numbers(std::vector<Number>& numbers) {
  if (has_peeked_) {
    double number = 0;
    if (peeked_.kind != TokenKind::word || !parse_number(peeked_.text, number)) return;
    numbers.push_back(converted<Number>(number));
    has_peeked_ = false;
  }
  // Of long lists room is made at once: growing would touch all memory twice.
  constexpr std::ptrdiff_t long_list = 1 << 16, usual_bytes_of_number = 7;
  if (at_ >= next_close_) {
    const void* const close = std::memchr(at_, ']', size_t(end_ - at_));
    next_close_ = close ? static_cast<const char*>(close) : end_;
    if (close && next_close_ - at_ > long_list)
      reserve_large(numbers, size_t((next_close_ - at_) / usual_bytes_of_number));
  }
  for (;;) {
    skip_blanks();
    if (at_ == end_ || !begins_number(*at_)) return;
    std::string_view rest(at_, size_t(end_ - at_));
    double number = 0;
    if (take_decimal(rest, number) && (rest.empty() || ends_word(rest.front()))) [[likely]] {
      at_ = rest.data();
      numbers.push_back(converted<Number>(number));
      continue;
    }
    const Token word = scan();
    if (!parse_number(word.text, number))
      throw Error(ErrorKind::input, fmt::format("{} is no number", shown(word.text)),
                  "write a number such as 1, .5 or -2e3", place_of(word));
    numbers.push_back(converted<Number>(number));
  }
}

template void Tokenizer::take_numbers(std::vector<float>&);
template void Tokenizer::take_numbers(std::vector<double>&);
template void Tokenizer::take_numbers(std::vector<int32_t>&);

bool parse_number(std::string_view word, double& number) {
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  const char* const last = word.data() + word.size();
  const auto [end, error] = std::from_chars(word.data(), last, number);
  return error == std::errc() && end == last && std::isfinite(number);
}

std::string unescaped(std::string_view quoted) {
  std::string text;
  text.reserve(quoted.size());
  for (size_t i = 0; i < quoted.size(); ++i) {
    if (quoted[i] != '\\' || i + 1 == quoted.size()) {
      text += quoted[i];
      continue;
    }
    switch (const char c = quoted[++i]) {
      case 'b':
        text += '\b';
        break;
      case 'f':
        text += '\f';
        break;
      case 'n':
        text += '\n';
        break;
      case 'r':
        text += '\r';
        break;
      case 't':
        text += '\t';
        break;
      default:
        text += c;
    }
  }
  return text;
}

std::string shown(std::string_view text) {
  constexpr size_t longest = 60;
  std::string result = "'";
  for (const char c : text.substr(0, longest)) result += (c >= 0 && c < ' ') || c == 0x7f ? '?' : c;
  return result + (text.size() > longest ? "…'" : "'");
}

}  // namespace kaustik::pbrt
