#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "kaustik/base/error.h"
#include "kaustik/loader/load_options.h"

namespace kaustik {

/// A definition that a reader of a format without definitions of its own understands.
struct ReaderDefinition {
  std::string name;
  /// What it may be; none: any text.
  std::vector<std::string> choices;
};

/// What the user defined for such a reader.
class ReaderDefinitions {
 public:
  /// Throws Error(input) for names that are not among `known`, or given twice, and values that are
  /// not among their choices.
  ReaderDefinitions(const LoadOptions& options, const std::vector<ReaderDefinition>& known);

  /// Null: it is not defined.
  const std::string* find(std::string_view name) const;
  /// The number that it is, at least `least`; `usual` where it is not defined. Throws Error(input).
  double number(std::string_view name, double usual, double least) const;

 private:
  std::vector<std::pair<std::string, std::string>> given_;
  Place origin_;
};

}  // namespace kaustik
