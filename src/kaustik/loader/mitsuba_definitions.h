#pragma once
#include <map>
#include <set>
#include <string>
#include <string_view>

#include "kaustik/base/error.h"
#include "kaustik/loader/mitsuba_xml.h"

namespace kaustik::mitsuba {

/// What the `$name`s of a scene stand for: first what the user defined, then the file's
/// `<default>`.
class Definitions {
 public:
  Definitions(const LoadOptions& options, Problems& problems);

  /// Has no effect on a name that is defined already. Throws BadValue for what can be no name:
  /// empty, with a '$', or too long.
  void set_default(const std::string& name, const std::string& value);
  /// `text` with each `$name` replaced (of several names that fit the longest) and each `\$` by a
  /// dollar sign. Throws BadValue for an undefined name.
  std::string replace(std::string_view text);
  /// Adds a problem for each definition by the user that nothing in the scene mentions.
  void report_unused(Problems& problems) const;

 private:
  struct Definition {
    std::string value;
    bool used;
  };
  using Entry = std::pair<const std::string, Definition>;
  void insert(const std::string& name, Definition definition);
  Entry* longest_at(std::string_view text);
  [[noreturn]] void fail_undefined(std::string_view name) const;

  Place origin_;        ///< of what the user defined
  std::string prefix_;  ///< LoadOptions::definition_prefix
  std::map<std::string, Definition, std::less<>> definitions_;
  std::set<size_t> lengths_;     ///< of their names
  std::set<std::string> known_;  ///< names that the scene itself mentions
  size_t replaced_bytes_ = 0;
};

}  // namespace kaustik::mitsuba
