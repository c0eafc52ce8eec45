#pragma once
// Radiance's language of functions (.cal files): definitions of variables and functions by
// expressions. It has no loops, files or commands; functions may call themselves.

#include <cstdint>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace kaustik::radiance {

/// What is wrong with an expression or its value, a sentence without a full stop. The caller knows
/// the place.
class CalError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What it needs is in a file that is not there.
class MissingFile : public CalError {
 public:
  using CalError::CalError;
};

/// A node of an expression. `symbol` is a name's number; children are the operands.
struct CalNode {
  enum class Op : uint8_t { number, name, call, add, subtract, multiply, divide, power, negate };
  Op op = Op::number;
  double number = 0;
  uint32_t symbol = 0;
  std::vector<uint32_t> children;
};

/// `name(parameters) = expression`; a variable has no parameters.
struct CalDefinition {
  std::vector<uint32_t> parameters;
  uint32_t root = 0;
  bool is_function = false;
};

/// All definitions that are known together. The last one of a name counts.
class CalProgram {
 public:
  /// Longer sources are refused, and expressions that nest deeper.
  static constexpr size_t most_letters = size_t{1} << 20;
  static constexpr int deepest = 100;

  /// Adds the definitions of a source. Throws CalError with the line.
  void add(std::string_view source);
  /// Adds an expression that no name stands for; returns its node. Throws CalError.
  uint32_t add_expression(std::string_view source);

  /// The number of a name, the same for equal ones.
  uint32_t symbol_of(std::string_view name);
  const std::string& name_of(uint32_t symbol) const { return names_[symbol]; }
  size_t symbols() const { return names_.size(); }
  const CalNode& node(uint32_t index) const { return nodes_[index]; }
  /// Null where a name has none.
  const CalDefinition* definition_of(uint32_t symbol) const {
    const auto found = definitions_.find(symbol);
    return found == definitions_.end() ? nullptr : &found->second;
  }

 private:
  friend class CalParser;
  std::vector<CalNode> nodes_;
  std::vector<std::string> names_;
  std::map<std::string, uint32_t, std::less<>> symbols_;
  std::map<uint32_t, CalDefinition> definitions_;
};

}  // namespace kaustik::radiance
