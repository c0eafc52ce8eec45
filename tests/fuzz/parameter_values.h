#pragma once
#include <string>

#include "kaustik/base/parameters.h"
#include "tests/fuzz/draw.h"

namespace kaustik::fuzz {

/// Writes properties of scene files: values of a parameter's kind, usual ones or, with the
/// probability `wildness`, from the ends of its range and of what numbers can be.
class ParameterValues {
 public:
  ParameterValues(Draw& draw, std::string files_folder)
      : draw_(draw), files_folder_(std::move(files_folder)) {}

  double wildness = 0;

  /// `<float name="radius" value="0.5"/>` and the like; "" where no value can be made up.
  std::string property(const TypeInfo& info, const Parameter& parameter);
  std::string transform(const std::string& name);
  /// Of a parameter with this default and range; mostly within the range.
  double number(const Parameter& parameter);

 private:
  bool is_wild() { return draw_.chance(wildness); }
  double wild_number();
  int64_t integer(const Parameter& parameter);
  std::string color(const Parameter& parameter);
  std::string point(const Parameter& parameter);
  std::string text(const TypeInfo& info, const Parameter& parameter);
  std::string file(const TypeInfo& info);
  std::string triple(double usual);
  std::string transform_step();
  std::string wild_transform_step();

  Draw& draw_;
  std::string files_folder_;
};

}  // namespace kaustik::fuzz
