#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kaustik::view {

/// A request's target: path and query, "/frame?after=3&layer=direct".
class Query {
 public:
  /// Throws RequestError for a target of another form.
  explicit Query(std::string_view target);

  const std::string& path() const { return path_; }
  /// Throws RequestError, which names it, if there is a field that is not one of these, or one
  /// twice.
  void allow_only(const std::vector<std::string_view>& names) const;
  /// Throw RequestError for what is no whole number within the bounds; `required` also if it is
  /// missing.
  std::optional<int64_t> integer(std::string_view name, int64_t least, int64_t most) const;
  int64_t required(std::string_view name, int64_t least, int64_t most) const;
  /// "" if it is missing.
  std::string text(std::string_view name) const;

 private:
  const std::string* find(std::string_view name) const;

  std::string path_;
  std::vector<std::pair<std::string, std::string>> fields_;
};

}  // namespace kaustik::view
