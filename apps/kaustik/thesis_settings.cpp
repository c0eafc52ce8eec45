#include "thesis_settings.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>

#include "kaustik/integrator/foreign_integrators.h"
#include "kaustik/integrator/registry.h"
#include "kaustik/scene/overrides.h"
#include "numbers.h"
#include "screen.h"

namespace kaustik::app {
namespace {

enum class Kind {
  same,    ///< the value of our parameter
  length,  ///< the same, at least 1
  flag,    ///< counts by being there
  quality  ///< of a tessellation: our parameter is a number of pieces
};

struct Variable {
  const char* name;
  const char* parameter;
  Kind kind = Kind::same;
};

constexpr Variable variables_of_thesis[] = {
    {"photonMap.numCaustic", "caustic_neighbors"},
    {"photonMap.totalCaustic", "caustic_photons"},
    {"photonMap.causticFilter", "caustic_filter"},
    {"photonMap.numGlobal", "global_neighbors"},
    {"photonMap.totalGlobal", "global_photons"},
    {"photonMap.numDiffuse", "diffuse_samples"},
    {"photonMap.impThetaIntervals", "importance_theta_cells"},
    {"photonMap.impPhiIntervals", "importance_phi_cells"},
    {"photonMap.minDist", "minimum_distance", Kind::flag},
    {"photonMap.specularSampling", "specular_sampling"},
    {"photonMap.numSpecular", "specular_samples"},
    {"photonMap.minRadiance", "minimum_radiance"},
    {"photonMap.reradiate", "reradiate", Kind::flag},
    {"photonMap.distribQuality", "aim_targets", Kind::quality},
    {"maxLightLevel", "max_light_level", Kind::length},
    {"maxEyeLevel", "max_eye_level"},
};

std::string lower_case(std::string text) {
  for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

const Variable* find_variable(const std::string& name) {
  for (const Variable& variable : variables_of_thesis)
    if (name == variable.name) return &variable;
  return nullptr;
}

[[noreturn]] void fail_unknown(const std::string& name, const Place& place) {
  std::vector<std::string> names;
  for (const Variable& variable : variables_of_thesis) names.emplace_back(variable.name);
  throw Error(ErrorKind::input, fmt::format("the thesis has no variable '{}'", name),
              suggest(name, names), place);
}

[[noreturn]] void fail_value(const std::string& name, const std::string& value,
                             const std::string& remedy, const Place& place) {
  throw Error(ErrorKind::input, fmt::format("'{}' cannot be '{}'", name, value), remedy, place);
}

int whole_number(const Variable& variable, const std::string& value, int least,
                 const Place& place) {
  int number = 0;
  const char* end = value.data() + value.size();
  const auto [rest, code] = std::from_chars(value.data(), end, number);
  if (code != std::errc{} || rest != end || number < least)
    fail_value(variable.name, value, fmt::format("give a whole number, {} or larger", least),
               place);
  return number;
}

/// What our parameter has to be for the variable's value.
std::string translated(const Variable& variable, const std::string& value, const Place& place) {
  switch (variable.kind) {
    case Kind::same:
      if (value.empty()) fail_value(variable.name, value, "give a value, or unset it", place);
      break;
    case Kind::length:
      whole_number(variable, value, 1, place);
      break;
    case Kind::flag:
      for (const char* yes : {"", "1", "true", "yes", "on"})
        if (lower_case(value) == yes) return "true";
      fail_value(variable.name, value, "it counts by being there: unset it to switch it off",
                 place);
    case Kind::quality:
      // 128 boxes are the most that photons are aimed at.
      return std::to_string(32 << std::min(whole_number(variable, value, 0, place), 2));
  }
  return value;
}

bool is_of_thesis(const std::string& variable) {
  return lower_case(variable).starts_with("photonmap.");
}

const Parameter& parameter_of(const Variable& variable) {
  for (const IntegratorType& type : integrator_types())
    if (type.info.name == "photonmap")
      if (const Parameter* parameter = type.info.find(variable.parameter)) return *parameter;
  throw std::logic_error(fmt::format("photonmap has no parameter {}", variable.parameter));
}

}  // namespace

std::vector<std::string> environment() {
  std::vector<std::string> variables;
  for (char** entry = environ; entry && *entry; ++entry) variables.emplace_back(*entry);
  std::sort(variables.begin(), variables.end());
  return variables;
}

std::vector<Setting> thesis_settings(const std::optional<Object>& integrator,
                                     const std::vector<std::string>& variables,
                                     std::vector<std::string>& report) {
  std::vector<Setting> settings;
  for (const std::string& entry : variables) {
    const size_t equals = std::min(entry.find('='), entry.size());
    const std::string name = entry.substr(0, equals);
    const Variable* variable = find_variable(name);
    if (!variable && !is_of_thesis(name)) continue;
    if (integrator && native_type(*integrator) != "photonmap") {
      report.push_back(fmt::format("the environment's {} has no effect with integrator '{}'", name,
                                   integrator->type));
      return {};
    }
    const std::string origin = fmt::format("environment: {}", entry);
    const Place place = place_in(origin);
    if (!variable) fail_unknown(name, place);
    const std::string value =
        translated(*variable, entry.substr(std::min(equals + 1, entry.size())), place);
    settings.push_back({"integrator", variable->parameter, value, origin});
    report.push_back(
        fmt::format("{} of the environment: {} = {}", name, variable->parameter, value));
  }
  return settings;
}

void add_light_level(CLI::App& command, LevelOptions& levels) {
  command
      .add_option("-l", levels.light,
                  "Longest path of photons in scattering events (max_light_level)")
      ->type_name("N")
      ->check(whole_number(1, 1 << 20));
}

void add_eye_level(CLI::App& command, LevelOptions& levels) {
  command
      .add_option("-e", levels.eye,
                  "Levels of the camera path at which photonmap gathers (max_eye_level)")
      ->type_name("N")
      ->check(whole_number(0, 64));
}

bool sets_thesis_photon_map(const LevelOptions& levels) {
  if (levels.light || levels.eye) return true;
  for (const std::string& variable : environment())
    if (is_of_thesis(variable)) return true;
  return false;
}

std::vector<Setting> collected_settings(const std::optional<Object>& integrator,
                                        const LevelOptions& levels,
                                        const std::vector<std::string>& settings) {
  std::vector<std::string> report;
  std::vector<Setting> result = thesis_settings(integrator, environment(), report);
  for (const std::string& sentence : report) note(sentence);
  const auto set_level = [&](const char* option, const char* parameter, std::optional<int> level) {
    if (level)
      result.push_back({"integrator", parameter, std::to_string(*level),
                        fmt::format("command line: {} {}", option, *level)});
  };
  set_level("-l", "max_light_level", levels.light);
  set_level("-e", "max_eye_level", levels.eye);
  for (const std::string& setting : settings)
    result.push_back(setting_from(setting, "command line: --set " + setting));
  return result;
}

void print_thesis_variables() {
  fmt::print(
      "Environment variables that set the photon map in Schregle's thesis (1998, appendix A).\n"
      "They apply to integrator photonmap. --set, -l and -e override them; they override the "
      "scene\n"
      "file. Shells cannot assign names with a dot, but env can:\n"
      "  env photonMap.numGlobal=80 photonMap.minDist=1 kaustik render scene.xml\n"
      "For the thesis's defaults, set the integrator parameter preset = thesis.\n");
  for (const Variable& variable : variables_of_thesis) {
    const Parameter& parameter = parameter_of(variable);
    fmt::print("\n  {:28} {}\n      {}\n", variable.name, variable.parameter, parameter.sentence);
    if (variable.kind == Kind::flag)
      fmt::print("      A flag: on if the variable is set, even to nothing.\n");
    if (variable.kind == Kind::quality)
      fmt::print("      0, 1, 2: into 32, 64, 128 boxes; more changes nothing.\n");
    if (!parameter.choices.empty())
      fmt::print("      One of: {}\n", fmt::join(parameter.choices, ", "));
  }
}

}  // namespace kaustik::app
