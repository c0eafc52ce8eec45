#pragma once
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "kaustik/base/place.h"

namespace kaustik {

enum class ErrorKind {
  input,  ///< something wrong with what the user gave: exit code 2
  system  ///< the machine failed us (disk full, out of memory, no permission): exit code 1
};

/// One thing that is wrong.
struct Problem {
  std::string message;  ///< what was found and what is wrong with it
  std::string remedy;   ///< what to do; may be empty
  Place place;
};

/// One or several problems, reported together. what() is the whole text: per problem "file:line:
/// column: message", if it has a column an excerpt of that line with a caret, and the remedy.
class Error : public std::exception {
 public:
  Error(ErrorKind kind, std::vector<Problem> problems);
  Error(ErrorKind kind, std::string message, std::string remedy = {}, Place place = {});

  const char* what() const noexcept override { return text_.c_str(); }
  ErrorKind kind() const { return kind_; }
  const std::vector<Problem>& problems() const { return problems_; }

 private:
  ErrorKind kind_;
  std::vector<Problem> problems_;
  std::string text_;
};

/// Collects input problems so that several are told at once; a list that grows over
/// `maximum` gives up at once.
class Problems {
 public:
  static constexpr size_t maximum = 20;
  void add(std::string message, std::string remedy = {}, Place place = {});
  bool empty() const { return problems_.empty(); }
  /// Throws Error(ErrorKind::input) with all problems if there are any.
  void throw_if_any() const;

 private:
  std::vector<Problem> problems_;
};

/// "file:line:column", as far as it is known; "" if nothing is.
std::string text_of(const Place& place);
/// A remedy for what is there twice: tells where the first one stands, if that is known.
std::string keep_one(const Place& first);

/// The candidate with the smallest edit distance to `name`, or "" if none is near.
std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates);
/// "did you mean 'x'? Valid: a, b, c", for a remedy.
std::string suggest(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace kaustik
