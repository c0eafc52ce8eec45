#include "exit_codes.h"

#include <fmt/format.h>

namespace kaustik::app {

const std::vector<ExitCode>& exit_codes() {
  static const std::vector<ExitCode> codes{
      {"0", "all was done"},
      {std::to_string(exit_system),
       "the machine failed: disk full, not enough memory, or an output could not be written; or a "
       "test of kaustik test failed"},
      {std::to_string(exit_input),
       "something is wrong with the command line, the scene or another file"},
      {std::to_string(exit_ended_early),
       "ended early by Ctrl-C or another signal, or a part by its time limit: the finished passes "
       "are "
       "written"},
      {"128+n", "ended at once by signal n, such as a second Ctrl-C: files are unchanged"}};
  return codes;
}

std::string exit_code_text() {
  std::string text = "Exit codes:";
  for (const ExitCode& row : exit_codes())
    text += fmt::format("\n  {:5} {}", row.code, row.meaning);
  return text;
}

}  // namespace kaustik::app
