#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kaustik/base/place.h"

namespace kaustik::radiance {

/// The words of a program that is called, its name first.
using Words = std::vector<std::string>;

/// The programs of a command line, each of which reads what the one before it writes. As in a shell
/// blanks part words, quotes hold them together, and '|' stands between programs. Throws
/// Error(input) for all else that shells know: lists of commands, files to write to, variables.
std::vector<Words> split_command(std::string_view text, const Place& place);

/// Of a program's arguments, by their positions from 0.
class CommandArguments {
 public:
  /// Of `words` behind the name; both must outlive this. `usage` is the remedy in messages.
  CommandArguments(const Words& words, std::string usage, Place place)
      : name_(words.at(0)), words_(words), usage_(std::move(usage)), place_(std::move(place)) {}

  const std::string& name() const { return name_; }
  const Place& place() const { return place_; }
  bool at_end() const { return at_ >= words_.size(); }
  bool at_option() const;
  /// These throw Error(input) where nothing is left, or it is none.
  std::string text();
  double number();
  /// From 1 to `most`.
  size_t count(size_t most);
  [[noreturn]] void refuse(const std::string& message) const;

 private:
  std::string name_;
  std::span<const std::string> words_;
  std::string usage_;
  Place place_;
  size_t at_ = 1;
};

}  // namespace kaustik::radiance
