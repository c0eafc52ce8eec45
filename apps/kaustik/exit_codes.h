#pragma once
#include <string>
#include <vector>

namespace kaustik::app {

// What the program ends with.
inline constexpr int exit_system = 1;       ///< the machine failed
inline constexpr int exit_test_failed = 1;  ///< a test of `kaustik test`
inline constexpr int exit_input = 2;        ///< something is wrong with what the user gave
/// A signal came before all was done, or the end of its time before a part was.
inline constexpr int exit_ended_early = 75;

struct ExitCode {
  std::string code;  ///< "75", "128+n"
  std::string meaning;
};
/// The one table of them: help, man pages and docs/reference/cli.md show it.
const std::vector<ExitCode>& exit_codes();
/// The same in lines.
std::string exit_code_text();

/// Thrown when all that can be written is written, but the command ended early.
struct EndedEarly {};
/// Thrown when all tests have run and are told, and some of them failed.
struct TestsFailed {};

}  // namespace kaustik::app
