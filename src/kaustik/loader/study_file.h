#pragma once
// Studies: one scene rendered in many variants, as a file of JSON says.

#include <string>
#include <vector>

#include "kaustik/base/place.h"

namespace kaustik {

/// What is changed from one variant to the next.
enum class StudyTarget {
  definition,  ///< a variable of the scene file: -D name=value
  parameter,   ///< of an object: --set object.parameter=value
  option       ///< of the render command: --name value
};

/// Something with a value of its own in each variant, or one for all of them.
struct StudySetting {
  StudyTarget target = StudyTarget::option;
  std::string name;
  Place place;
};

/// A value, as the command line has it, and what tables and file names call it.
struct StudyValue {
  std::string text, label;
};

/// What a study varies, and the values that it takes one after the other.
struct StudyFactor {
  StudySetting setting;
  std::string label;  ///< the factor's name in tables and file names
  std::vector<StudyValue> values;
};

/// An option that all variants have. Without values it is a switch; with several it is repeated.
struct StudyOption {
  StudySetting setting;
  std::vector<std::string> values;
};

struct Study {
  std::string scene;                 ///< the file, relative to the working folder or absolute
  std::string folder;                ///< for all that is written; likewise
  std::string scene_as_written;      ///< relative to the study\'s own folder, or absolute
  std::vector<std::string> outputs;  ///< extensions of the files that each variant writes
  std::vector<StudyOption> options;
  std::vector<StudyFactor> factors;
  bool has_seed_for_each = false;  ///< variants have random numbers of their own

  /// The product of the factors' numbers of values.
  size_t variant_count() const;
};

/// Variants that a study may have.
inline constexpr size_t most_variants = 1'000'000;

/// Reads "scene", "folder" [the file's name without its extension], "outputs" ["exr"], "options",
/// "factors", and "seed", "fixed" [the default] or "each". Scene and folder are relative to the
/// study's own folder. Throws Error(input) with line and column.
Study read_study(const std::string& path);

}  // namespace kaustik
