#pragma once
// Schregle's thesis sets its photon map by variables of the environment (1998, appendix A):
//   env photonMap.numGlobal=80 kaustik render …
#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "kaustik/scene/description.h"

namespace kaustik::app {

/// The variables of this program's environment, as "name=value".
std::vector<std::string> environment();

/// Applies the thesis's variables among `variables` to the description's photonmap integrator (the
/// default one if the scene names none); settings made later win. Returns a sentence for each that
/// was applied, or one that none was because the integrator is another. Throws Error for an unknown
/// photonMap.… and for what is no value; the integrator's table checks numbers and names.
std::vector<std::string> apply_thesis_variables(Description& description,
                                                const std::vector<std::string>& variables);

/// The thesis's options.
struct LevelOptions {
  std::optional<int> light, eye;
};
void add_light_level(CLI::App& command, LevelOptions& levels);  ///< -l
void add_eye_level(CLI::App& command, LevelOptions& levels);    ///< -e

/// Applies the variables of this program's environment (and tells of them), the options and then
/// `settings` ("object.parameter=value"): later ones win.
void apply_settings(Description& description, const LevelOptions& levels,
                    const std::vector<std::string>& settings);

/// The variables with their meaning, for `kaustik help thesis`.
void print_thesis_variables();

}  // namespace kaustik::app
