#pragma once
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "kaustik/base/error.h"
#include "kaustik/loader/mitsuba_xml.h"

namespace kaustik::mitsuba {

/// What the `$name`s of a scene stand for: first what the user defined, then the file's
/// `<default>`.
class Definitions {
 public:
  Definitions(const LoadOptions& options, Problems& problems);

  /// Has no effect on a name that is defined already.
  void set_default(const std::string& name, const std::string& value);
  /// `text` with each `$name` replaced (of several names that fit the longest) and each `\$` by a
  /// dollar sign. Throws BadValue for an undefined name.
  std::string replace(std::string_view text);
  /// Adds a problem for each definition by the user that nothing in the scene mentions.
  void report_unused(Problems& problems) const;

 private:
  struct Definition {
    std::string name;
    std::string value;
    bool used;
  };
  Definition* find(std::string_view name);
  void insert(Definition definition);
  Definition* longest_at(std::string_view text);
  [[noreturn]] void fail_undefined(std::string_view name) const;

  std::vector<Definition> definitions_;  ///< longest name first
  std::set<std::string> known_;          ///< names that the scene itself mentions
  size_t replaced_bytes_ = 0;
};

}  // namespace kaustik::mitsuba
