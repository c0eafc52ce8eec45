#include "kaustik/loader/radiance/command_line.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "kaustik/base/error.h"
#include "kaustik/loader/radiance/number_text.h"

namespace kaustik::radiance {
namespace {

[[noreturn]] void refuse_shell(char letter, const Place& place) {
  throw Error(ErrorKind::input,
              fmt::format("the command has a '{}', which only a shell understands", letter),
              "commands are not run: write what this one prints into a file, as in "
              "'xform -e scene.rad > flat.rad', and load that",
              place);
}

}  // namespace

std::vector<Words> split_command(std::string_view text, const Place& place) {
  std::vector<Words> programs(1);
  std::string word;
  bool in_word = false;
  const auto end_word = [&] {
    if (in_word) programs.back().push_back(std::move(word));
    word.clear();
    in_word = false;
  };
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\'' || c == '"') {
      const size_t end = text.find(c, i + 1);
      if (end == std::string_view::npos)
        throw Error(ErrorKind::input, "a quote in the command has no end", "close it", place);
      word += text.substr(i + 1, end - i - 1);
      in_word = true;
      i = end;
    } else if (c == '|') {
      end_word();
      programs.emplace_back();
    } else if (c == ' ' || c == '\t' || c == '\r') {
      end_word();
    } else if (c == '\\' && i + 1 < text.size()) {
      word += text[++i];
      in_word = true;
    } else if (std::string_view(";&<>`$(){}").find(c) != std::string_view::npos) {
      refuse_shell(c, place);
    } else if (c == '#' && !in_word) {
      break;
    } else {
      word += c;
      in_word = true;
    }
  }
  end_word();
  for (const Words& program : programs)
    if (program.empty())
      throw Error(ErrorKind::input, "a command is empty", "write a program's name behind the '!'",
                  place);
  return programs;
}

bool CommandArguments::at_option() const {
  if (at_end() || words_[at_].size() < 2) return false;
  const std::string& word = words_[at_];
  return (word[0] == '-' || word[0] == '+') && !number_of(word);
}

std::string CommandArguments::text() {
  if (at_end()) refuse(fmt::format("'{}' has too few arguments", name_));
  return words_[at_++];
}

double CommandArguments::number() {
  const std::string word = text();
  const auto value = number_of(word);
  if (!value)
    refuse(fmt::format("'{}' stands where '{}' expects a number", word.substr(0, 40), name_));
  return *value;
}

size_t CommandArguments::count(size_t most) {
  const double value = std::floor(number() + 0.5);
  if (!(value >= 1 && value <= double(most)))
    refuse(fmt::format("'{}' has a count that is not between 1 and {}", name_, most));
  return size_t(value);
}

void CommandArguments::refuse(const std::string& message) const {
  throw Error(ErrorKind::input, message, "write " + usage_, place_);
}

}  // namespace kaustik::radiance
