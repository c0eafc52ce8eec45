#include "program.h"

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <csignal>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include "commands.h"
#include "events.h"
#include "exit_codes.h"
#include "first_steps.h"
#include "kaustik/base/error.h"
#include "kaustik/base/processors.h"
#include "kaustik/base/thread_limit.h"
#include "kaustik/base/version.h"
#include "scene_search.h"
#include "screen.h"
#include "signals.h"
#include "standard_streams.h"
#include "version_json.h"

namespace {

/// Passes free and ask for the same large arrays again and again: keeping the pages spares the
/// system from clearing them anew, 5 % of a light pass.
void keep_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
#endif
}

/// CLI11 would only say that a subcommand is missing.
void check_command(const std::string& name, const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands({})) names.push_back(command->get_name());
  if ((name.starts_with('-') && name != "-") ||
      std::find(names.begin(), names.end(), name) != names.end())
    return;
  if (const std::string command = kaustik::app::command_line_for(name); !command.empty())
    throw kaustik::Error(kaustik::ErrorKind::input, fmt::format("'{}' is no command", name),
                         command);
  throw kaustik::Error(kaustik::ErrorKind::input, fmt::format("there is no command '{}'", name),
                       kaustik::suggest(name, names));
}

/// In groups, as --help lists them.
void add_commands(CLI::App& program) {
  using namespace kaustik::app;
  struct Group {
    const char* name;
    std::vector<void (*)(CLI::App&)> commands;
  };
  const Group groups[] = {{"Scenes", {add_example, add_info, add_convert, add_test}},
                          {"Render", {add_render, add_view, add_resume, add_photons, add_learn}},
                          {"Pictures", {add_tonemap, add_compare, add_denoise}},
                          {"Parts", {add_batch, add_merge, add_stitch}},
                          {"Help", {add_help, add_man, add_completion}}};
  for (const Group& group : groups)
    for (const auto add : group.commands) {
      add(program);
      program.get_subcommands({}).back()->group(group.name);
    }
}

/// CLI11 would list all words that it cannot place, the last one first.
kaustik::Error unknown_word(const CLI::App& program) {
  using namespace kaustik;
  const CLI::App& command =
      program.get_subcommands().empty() ? program : *program.get_subcommands().front();
  const std::vector<std::string> words = program.remaining(true);
  const auto option = std::find_if(words.begin(), words.end(), [](const std::string& word) {
    return word.size() > 1 && word.starts_with('-');
  });
  const std::string all = fmt::format("all options: kaustik {} --help", command.get_name());
  if (option == words.end())
    return Error(ErrorKind::input,
                 fmt::format("'{}' is one word too many", words.empty() ? "" : words.front()), all);
  const std::string name = option->substr(0, option->find('='));
  if ((name == "--width" || name == "--height") && command.get_option_no_throw("--set"))
    return Error(ErrorKind::input, fmt::format("there is no option {}", name),
                 fmt::format("change the film: --set film.{}=…", name.substr(2)));
  std::vector<std::string> known;
  for (const CLI::Option* one : command.get_options())
    for (const std::string& known_name : one->get_lnames()) known.push_back("--" + known_name);
  return Error(ErrorKind::input, fmt::format("there is no option {}", name),
               suggest(name, known) + "; " + all);
}

int run(int argc, char** argv) {
  CLI::App program{"Kaustik: a photon mapping renderer in physical units.", "kaustik"};
  auto as_json = std::make_shared<bool>(false);
  auto* json =
      program.add_flag("--json", *as_json,
                       "With --version: print JSON, with the libraries and options of the build");
  json->needs(program.set_version_flag(
      "--version",
      [as_json] { return *as_json ? kaustik::app::version_json() : std::string(KAUSTIK_VERSION); },
      "Print the version"));
  program.require_subcommand(1);
  program.footer(
      "Start with: kaustik example caustic\n"
      "Every parameter of every object: kaustik help\n\n" +
      kaustik::app::exit_code_text());
  add_commands(program);
  if (argc <= 1) {
    // Nothing was asked for: scripts whose command got lost have to notice.
    kaustik::app::screen().tell(kaustik::app::Level::plain, kaustik::app::first_steps(program));
    return kaustik::app::exit_input;
  }
  check_command(argv[1], program);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ExtrasError&) {
    throw unknown_word(program);
  } catch (const CLI::ParseError& error) {
    if (program.exit(error) != 0) return kaustik::app::exit_input;
  }
  kaustik::app::finish_standard_output();
  return 0;
}

/// What ended the program before its time, in words, which `message` keeps, and as its exit code;
/// called where it is caught.
int told(std::string& message) {
  using namespace kaustik::app;
  try {
    throw;
  } catch (const EndedEarly&) {
    return exit_ended_early;
  } catch (const TestsFailed&) {
    return exit_test_failed;
  } catch (const ReaderGone&) {
    events().end(128 + SIGPIPE, "nobody reads standard output");
    end_by_broken_pipe();
  } catch (const kaustik::Error& error) {
    screen().tell(Level::error, message = error.what());
    return error.kind() == kaustik::ErrorKind::input ? exit_input : exit_system;
  } catch (const std::bad_alloc&) {
    message =
        "not enough memory\n  remedy: free some, or ask for less: smaller pictures, fewer photons";
    screen().tell(Level::error, message);
  } catch (const std::exception& error) {
    screen().tell(Level::error, message = error.what());
  }
  return exit_system;
}

/// Runs the command to its end, whichever that is; returns the exit code, and what went wrong in
/// `message`.
int run_and_tell(int argc, char** argv, std::string& message) {
  int exit_code = kaustik::app::exit_system;
  bool is_told = true, is_output_told = false;
  try {
    return run(argc, argv);
  } catch (const kaustik::app::EndedEarly&) {
    exit_code = told(message);
  } catch (const kaustik::Error& error) {
    exit_code = told(message);
    is_output_told = std::string_view(error.what()).find("standard output") != std::string::npos;
  } catch (...) {
    // Printing throws, too, but knows no reason.
    if (!kaustik::app::standard_output_failed()) return told(message);
    is_told = false;
  }
  if (!kaustik::app::standard_output_failed()) return exit_code;
  try {
    kaustik::app::finish_standard_output();
  } catch (const kaustik::app::ReaderGone&) {
    if (!is_told) told(message);
  } catch (...) {
    if (!is_output_told) told(message);
  }
  return exit_code;
}

}  // namespace

namespace kaustik::app {

int run_program(int argc, char** argv) {
  keep_memory();
  // A file that grows over the limit is then an error of the write, not the program's end.
  std::signal(SIGXFSZ, SIG_IGN);
  listen_for_requests();
  prepare_standard_streams();
  const ThreadLimit limit(usable_processors());
  std::string message;
  const int exit_code = run_and_tell(argc, argv, message);
  events().end(exit_code, message);
  return exit_code;
}

}  // namespace kaustik::app
