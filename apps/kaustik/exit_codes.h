#pragma once

namespace kaustik::app {

// What the program ends with; help and docs/command_line.md have the same table.
inline constexpr int exit_system = 1;        ///< the machine failed
inline constexpr int exit_input = 2;         ///< something is wrong with what the user gave
inline constexpr int exit_ended_early = 75;  ///< a signal came before all was done

inline constexpr const char* exit_code_table =
    "Exit codes:\n"
    "  0     all was done\n"
    "  1     the machine failed: disk full, not enough memory, an output could not be written\n"
    "  2     something is wrong with the command line, the scene or another file\n"
    "  75    ended early by Ctrl-C or another signal: what was finished is written\n"
    "  128+n ended at once by signal n, such as a second Ctrl-C: files are as they were";

/// Thrown when all that can be written is written, but a signal came before all was done.
struct EndedEarly {};

}  // namespace kaustik::app
