#include "kaustik/loader/radiance/cal_program.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace kaustik::radiance {

/// By recursive descent. `^` binds most closely and to the right, signs come before it.
class CalParser {
 public:
  CalParser(CalProgram& program, std::string_view text) : program_(program), text_(text) {
    if (text.size() > CalProgram::most_letters) fail("the source is too long");
  }

  void definitions() {
    for (skip(); at_ < text_.size(); skip()) {
      if (take(';')) continue;
      definition();
    }
  }
  uint32_t whole_expression() {
    const uint32_t root = sum();
    take(';');
    skip();
    if (at_ < text_.size()) fail(fmt::format("'{}' is left over", text_.substr(at_, 20)));
    return root;
  }

 private:
  using Op = CalNode::Op;

  /// Counts how deep expressions nest.
  class Level {
   public:
    explicit Level(CalParser& parser) : depth_(parser.depth_) {
      if (++depth_ > CalProgram::deepest) parser.fail("expressions nest too deep");
    }
    ~Level() { --depth_; }
    Level(const Level&) = delete;
    Level& operator=(const Level&) = delete;

   private:
    int& depth_;
  };

  [[noreturn]] void fail(const std::string& why) const {
    const auto line = 1 + std::count(text_.begin(), text_.begin() + ptrdiff_t(at_), '\n');
    throw CalError(fmt::format("line {}: {}", line, why));
  }

  /// Blanks and comments in braces, which nest.
  void skip() {
    for (int braces = 0; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '{') {
        ++braces;
      } else if (braces > 0) {
        braces -= c == '}' ? 1 : 0;
      } else if (c != ' ' && !(c >= '\t' && c <= '\r')) {
        return;
      }
    }
  }
  bool take(char letter) {
    skip();
    if (at_ >= text_.size() || text_[at_] != letter) return false;
    ++at_;
    return true;
  }
  void expect(char letter, const char* where) {
    if (!take(letter)) fail(fmt::format("'{}' is missing {}", letter, where));
  }
  static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
  static bool is_digit(char c) { return c >= '0' && c <= '9'; }

  std::string_view name() {
    skip();
    const size_t begin = at_;
    if (at_ < text_.size() && (is_letter(text_[at_]) || text_[at_] == '_'))
      while (at_ < text_.size() &&
             (is_letter(text_[at_]) || is_digit(text_[at_]) ||
              std::string_view("_.`").find(text_[at_]) != std::string_view::npos))
        ++at_;
    if (at_ == begin) fail("a name is missing");
    // A backquote at the end stands for the context of all.
    std::string_view found = text_.substr(begin, at_ - begin);
    while (found.size() > 1 && found.ends_with('`')) found.remove_suffix(1);
    return found;
  }

  void definition() {
    CalDefinition made;
    const uint32_t symbol = program_.symbol_of(name());
    if (take('(')) {
      made.is_function = true;
      do made.parameters.push_back(program_.symbol_of(name()));
      while (take(','));
      expect(')', "behind parameters");
    }
    if (!take('=') && !take(':')) fail("'=' is missing behind a name");
    made.root = sum();
    skip();
    if (at_ < text_.size()) expect(';', "at the end of a definition");
    program_.definitions_[symbol] = std::move(made);
  }

  uint32_t add(CalNode node) {
    program_.nodes_.push_back(std::move(node));
    return uint32_t(program_.nodes_.size() - 1);
  }
  uint32_t add(Op op, std::vector<uint32_t> children) {
    return add(CalNode{op, 0, 0, std::move(children)});
  }

  /// Long sums go to the left, without nesting here; their depth counts when they are evaluated.
  uint32_t sum() {
    const Level level(*this);
    uint32_t left = product();
    for (int terms = 0;; ++terms) {
      if (terms > CalProgram::deepest) fail("an expression is too long");
      if (take('+'))
        left = add(Op::add, {left, product()});
      else if (take('-'))
        left = add(Op::subtract, {left, product()});
      else
        return left;
    }
  }
  uint32_t product() {
    uint32_t left = power();
    for (int terms = 0;; ++terms) {
      if (terms > CalProgram::deepest) fail("an expression is too long");
      if (take('*'))
        left = add(Op::multiply, {left, power()});
      else if (take('/'))
        left = add(Op::divide, {left, power()});
      else
        return left;
    }
  }
  uint32_t power() {
    const Level level(*this);
    const uint32_t base = signed_term();
    return take('^') ? add(Op::power, {base, power()}) : base;
  }
  uint32_t signed_term() {
    const Level level(*this);
    if (take('-')) return add(Op::negate, {signed_term()});
    if (take('+')) return signed_term();
    return term();
  }
  uint32_t term() {
    skip();
    if (take('(')) {
      const uint32_t inner = sum();
      expect(')', "at the end of an expression");
      return inner;
    }
    if (at_ >= text_.size()) fail("an expression is missing");
    if (is_digit(text_[at_]) || text_[at_] == '.') return number();
    if (text_[at_] == '$') fail("channels ($) are not known here");
    const uint32_t symbol = program_.symbol_of(name());
    if (!take('(')) return add(CalNode{Op::name, 0, symbol, {}});
    CalNode call{Op::call, 0, symbol, {}};
    do call.children.push_back(sum());
    while (take(','));
    expect(')', "behind arguments");
    return add(std::move(call));
  }
  uint32_t number() {
    double value = 0;
    const auto [end, error] =
        std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error != std::errc()) fail("a number is wrong");
    at_ = size_t(end - text_.data());
    return add(CalNode{Op::number, value, 0, {}});
  }

  CalProgram& program_;
  std::string_view text_;
  size_t at_ = 0;
  int depth_ = 0;
};

void CalProgram::add(std::string_view source) { CalParser(*this, source).definitions(); }

uint32_t CalProgram::add_expression(std::string_view source) {
  return CalParser(*this, source).whole_expression();
}

uint32_t CalProgram::symbol_of(std::string_view name) {
  const auto found = symbols_.find(name);
  if (found != symbols_.end()) return found->second;
  const auto symbol = uint32_t(names_.size());
  names_.emplace_back(name);
  symbols_.emplace(name, symbol);
  return symbol;
}

}  // namespace kaustik::radiance
