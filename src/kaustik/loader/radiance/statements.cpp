#include "kaustik/loader/radiance/statements.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "kaustik/base/error.h"
#include "kaustik/loader/near_names.h"
#include "kaustik/loader/radiance/number_text.h"

namespace kaustik::radiance {
namespace {

/// Old spellings among them.
constexpr auto types = std::to_array<std::pair<std::string_view, Kind>>({
    {"polygon", Kind::surface},     {"sphere", Kind::surface},     {"bubble", Kind::surface},
    {"ring", Kind::surface},        {"cylinder", Kind::surface},   {"tube", Kind::surface},
    {"cone", Kind::surface},        {"cup", Kind::surface},        {"source", Kind::surface},
    {"instance", Kind::surface},    {"mesh", Kind::surface},       {"plastic", Kind::material},
    {"metal", Kind::material},      {"trans", Kind::material},     {"plastic2", Kind::material},
    {"metal2", Kind::material},     {"trans2", Kind::material},    {"ashik2", Kind::material},
    {"dielectric", Kind::material}, {"interface", Kind::material}, {"glass", Kind::material},
    {"mirror", Kind::material},     {"light", Kind::material},     {"illum", Kind::material},
    {"glow", Kind::material},       {"spotlight", Kind::material}, {"prism1", Kind::material},
    {"prism2", Kind::material},     {"mist", Kind::material},      {"antimatter", Kind::material},
    {"plasfunc", Kind::material},   {"metfunc", Kind::material},   {"transfunc", Kind::material},
    {"BRTDfunc", Kind::material},   {"plasdata", Kind::material},  {"metdata", Kind::material},
    {"transdata", Kind::material},  {"BSDF", Kind::material},      {"aBSDF", Kind::material},
    {"WGMDfunc", Kind::material},   {"brightfunc", Kind::pattern}, {"brightdata", Kind::pattern},
    {"brighttext", Kind::pattern},  {"colorfunc", Kind::pattern},  {"colordata", Kind::pattern},
    {"colorpict", Kind::pattern},   {"colortext", Kind::pattern},  {"spectrum", Kind::pattern},
    {"specfile", Kind::pattern},    {"specfunc", Kind::pattern},   {"specdata", Kind::pattern},
    {"specpict", Kind::pattern},    {"texfunc", Kind::texture},    {"texdata", Kind::texture},
    {"mixfunc", Kind::mixture},     {"mixdata", Kind::mixture},    {"mixpict", Kind::mixture},
    {"mixtext", Kind::mixture},     {"alias", Kind::alias},
});

bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

struct Word {
  std::string text;
  size_t at = 0;
};

/// Words, and where they stand.
class Scanner {
 public:
  Scanner(std::string_view text, const PlaceAt& place_at) : text_(text), place_at_(place_at) {}

  Place here() const { return place_at_(at_); }
  Place place_of(const Word& word) const { return place_at_(word.at); }

  /// To the next letter that says something; false at the end.
  bool skip_to_statement() {
    for (; at_ < text_.size(); ++at_) {
      if (is_space(text_[at_])) continue;
      if (text_[at_] != '#') return true;
      at_ = std::min(text_.find('\n', at_), text_.size() - 1);  // then behind it
    }
    return false;
  }
  bool at_command() const { return text_[at_] == '!'; }

  /// The rest of the line behind the '!'; a backslash at its end is a blank.
  std::string command() {
    std::string line;
    for (++at_; at_ < text_.size() && text_[at_] != '\n'; ++at_) {
      const std::string_view rest = text_.substr(at_);
      const size_t end = rest.starts_with("\\\n") ? 2 : rest.starts_with("\\\r\n") ? 3 : 0;
      line += end > 0 ? ' ' : text_[at_];
      if (end > 0) at_ += end - 1;
    }
    return line;
  }

  /// Throws where the text ends; `what` is expected there.
  Word word(std::string_view what) {
    while (at_ < text_.size() && is_space(text_[at_])) ++at_;
    if (at_ >= text_.size())
      throw Error(ErrorKind::input, fmt::format("the file ends where {} should stand", what),
                  "the file may be cut off; a primitive is 'modifier type id' and three counted "
                  "lists: strings, integers, reals",
                  place_at_(text_.empty() ? 0 : text_.size() - 1));
    Word word{{}, at_};
    if (text_[at_] == '"' || text_[at_] == '\'') {
      const size_t end = text_.find(text_[at_], at_ + 1);
      if (end != std::string_view::npos) {
        word.text = text_.substr(at_ + 1, end - at_ - 1);
        at_ = end + 1;
        return word;
      }
    }
    while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
    word.text = text_.substr(word.at, at_ - word.at);
    return word;
  }

  double number(std::string_view what) {
    const Word word = this->word(what);
    const std::optional<double> value = number_of(word.text);
    if (!value) refuse(word, what, "a number such as 0.5 or 1e-3");
    return *value;
  }

  size_t count(std::string_view what) {
    const Word word = this->word(what);
    size_t value = 0;
    const auto [end, error] =
        std::from_chars(word.text.data(), word.text.data() + word.text.size(), value);
    if (error != std::errc() || end != word.text.data() + word.text.size())
      refuse(word, what, "how many arguments follow");
    // Each takes a letter and a blank.
    if (value > (text_.size() - at_) / 2 + 1)
      throw Error(ErrorKind::input,
                  fmt::format("{} is more than the rest of the file holds", value),
                  "correct the count", place_of(word));
    return value;
  }

 private:
  [[noreturn]] void refuse(const Word& word, std::string_view what, std::string_view remedy) const {
    throw Error(ErrorKind::input,
                fmt::format("'{}' stands where {} should stand", word.text.substr(0, 40), what),
                fmt::format("write {}", remedy), place_of(word));
  }

  std::string_view text_;
  const PlaceAt& place_at_;
  size_t at_ = 0;
};

[[noreturn]] void refuse_type(const std::string& type, const Place& place) {
  std::vector<std::string> names;
  for (const auto& row : types) names.emplace_back(row.first);
  const std::string remedy = did_you_mean(type, names);
  throw Error(ErrorKind::input, fmt::format("there is no primitive of type '{}'", type),
              remedy.empty() ? "check the counts of arguments of the primitive before: what is "
                               "left over is taken for the next one"
                             : remedy,
              place);
}

Primitive read_primitive(Scanner& scanner) {
  Primitive made;
  made.place = scanner.here();
  made.modifier = scanner.word("a modifier").text;
  const Word type = scanner.word("a type");
  made.type = type.text;
  const Kind kind = kind_of(made.type);
  if (kind == Kind::unknown) refuse_type(made.type.substr(0, 40), scanner.place_of(type));
  made.id = scanner.word("an identifier").text;
  if (kind == Kind::alias) {
    made.strings = {scanner.word("the modifier that the alias stands for").text};
    return made;
  }
  for (size_t left = scanner.count("the number of strings"); left > 0; --left)
    made.strings.push_back(scanner.word("a string argument").text);
  for (size_t left = scanner.count("the number of integers"); left > 0; --left)
    scanner.number("an integer argument");
  const size_t reals = scanner.count("the number of reals");
  made.reals.reserve(reals);
  for (size_t left = reals; left > 0; --left) made.reals.push_back(scanner.number("a number"));
  return made;
}

}  // namespace

Kind kind_of(std::string_view type) {
  for (const auto& [name, kind] : types)
    if (name == type) return kind;
  return Kind::unknown;
}

Statements read_statements(std::string_view text, const PlaceAt& place_at) {
  Statements statements;
  Scanner scanner(text, place_at);
  while (scanner.skip_to_statement()) {
    if (scanner.at_command()) {
      const Place place = scanner.here();
      statements.emplace_back(Command{scanner.command(), place});
    } else {
      statements.emplace_back(read_primitive(scanner));
    }
  }
  return statements;
}

bool begins_as_statements(std::string_view text) {
  const PlaceAt nowhere = [](size_t) { return Place(); };
  Scanner scanner(text, nowhere);
  try {
    if (!scanner.skip_to_statement()) return false;
    if (scanner.at_command()) return true;
    scanner.word("");
    return kind_of(scanner.word("").text) != Kind::unknown;
  } catch (const Error&) {
    return false;
  }
}

bool holds_statements(std::string_view text) {
  const PlaceAt nowhere = [](size_t) { return Place(); };
  return Scanner(text, nowhere).skip_to_statement();
}

std::string name_of(const Primitive& primitive) {
  return fmt::format("{} '{}'", primitive.type, primitive.id);
}

}  // namespace kaustik::radiance
