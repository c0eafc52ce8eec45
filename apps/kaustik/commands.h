#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

namespace kaustik::app {

// One file per subcommand: each adds itself to the program with its options and its action.
void add_render(CLI::App& program);
void add_tonemap(CLI::App& program);
void add_info(CLI::App& program);
void add_compare(CLI::App& program);
void add_denoise(CLI::App& program);
void add_photons(CLI::App& program);
void add_resume(CLI::App& program);
void add_learn(CLI::App& program);
void add_batch(CLI::App& program);
void add_merge(CLI::App& program);
void add_view(CLI::App& program);
void add_stitch(CLI::App& program);
void add_convert(CLI::App& program);
void add_test(CLI::App& program);
void add_help(CLI::App& program);
void add_man(CLI::App& program);
void add_completion(CLI::App& program);
void add_example(CLI::App& program);

// What an option's text says; throw Error(input) with the option as the place.

/// Splits "name=value" of -D.
std::vector<std::pair<std::string, std::string>> parse_definitions(
    const std::vector<std::string>& texts);

/// "60", "60s", "5m", "1h" in seconds, of `option`: "--time".
double parse_duration(const std::string& text, const std::string& option);
/// "2%" of --error as 0.02.
double parse_error_bound(const std::string& text);

}  // namespace kaustik::app
