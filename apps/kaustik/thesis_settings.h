#pragma once
// Schregle's thesis sets its photon map by variables of the environment (1998, appendix A):
//   env photonMap.numGlobal=80 kaustik render …
#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "kaustik/scene/overrides.h"

namespace kaustik::app {

/// The variables of this program's environment, as "name=value".
std::vector<std::string> environment();

/// What the thesis's variables among `variables` change in `integrator`, if that is a photonmap
/// (or none: then it becomes one); settings made later win. `report` gets a sentence for each, or
/// one that none has a say because the integrator is another. Throws Error for an unknown
/// photonMap.… and for what is no value; the integrator's table checks numbers and names.
std::vector<Setting> thesis_settings(const std::optional<Object>& integrator,
                                     const std::vector<std::string>& variables,
                                     std::vector<std::string>& report);

/// The thesis's options.
struct LevelOptions {
  std::optional<int> light, eye;
};
void add_light_level(CLI::App& command, LevelOptions& levels);  ///< -l
void add_eye_level(CLI::App& command, LevelOptions& levels);    ///< -e

/// Whether the options or a variable of this program's environment set anything.
bool sets_thesis_photon_map(const LevelOptions& levels);

/// What the variables of this program's environment (it tells of them), the options and `settings`
/// ("object.parameter=value") change, in the order in which they apply: later ones win.
std::vector<Setting> collected_settings(const std::optional<Object>& integrator,
                                        const LevelOptions& levels,
                                        const std::vector<std::string>& settings);

/// The variables with their meaning, for `kaustik help thesis`.
void print_thesis_variables();

}  // namespace kaustik::app
