#include <malloc.h>

#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <new>
#include <string_view>

#include "commands.h"
#include "exit_codes.h"
#include "kaustik/base/error.h"
#include "kaustik/base/version.h"
#include "standard_streams.h"

namespace {

/// Passes free and ask for the same large arrays again and again: keeping the pages spares the
/// system from clearing them anew, 5 % of a light pass.
void keep_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
#endif
}

/// The command that a file without one was likely meant for; "" if none.
std::string command_for(const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension().string();
  if (extension == ".xml" || file == "-") return "render";
  if (extension == ".kpt") return "resume";
  if (extension == ".exr" || extension == ".hdr" || extension == ".pfm") return "tonemap";
  return {};
}

/// CLI11 would only say that a subcommand is missing.
void check_command(const std::string& name, const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands({})) names.push_back(command->get_name());
  if ((name.starts_with('-') && name != "-") ||
      std::find(names.begin(), names.end(), name) != names.end())
    return;
  if (const std::string command = command_for(name); !command.empty())
    throw kaustik::Error(kaustik::ErrorKind::input, fmt::format("'{}' is no command", name),
                         fmt::format("kaustik {} {}{}", command, name,
                                     command == "tonemap" ? " -o PICTURE.png" : ""));
  throw kaustik::Error(kaustik::ErrorKind::input, fmt::format("there is no command '{}'", name),
                       kaustik::suggest(name, names));
}

int run(int argc, char** argv) {
  CLI::App program{"Kaustik: a photon mapping renderer in physical units.", "kaustik"};
  program.set_version_flag("--version", KAUSTIK_VERSION);
  program.require_subcommand(1);
  program.footer(
      "Start with: kaustik render scenes/cornell_box/cornell_box.xml -o cornell.exr -o "
      "cornell.png\n"
      "Every parameter of every object: kaustik help\n\n" +
      std::string(kaustik::app::exit_code_table));
  kaustik::app::add_render(program);
  kaustik::app::add_resume(program);
  kaustik::app::add_tonemap(program);
  kaustik::app::add_info(program);
  kaustik::app::add_compare(program);
  kaustik::app::add_denoise(program);
  kaustik::app::add_photons(program);
  kaustik::app::add_learn(program);
  kaustik::app::add_merge(program);
  kaustik::app::add_stitch(program);
  kaustik::app::add_convert(program);
  kaustik::app::add_help(program);
  if (argc > 1) check_command(argv[1], program);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (program.exit(error) != 0) return kaustik::app::exit_input;
  }
  kaustik::app::finish_standard_output();
  return 0;
}

/// What ended the program before its time, in words and as its exit code; called where it is
/// caught.
int told() {
  using namespace kaustik::app;
  try {
    throw;
  } catch (const EndedEarly&) {
    return exit_ended_early;
  } catch (const ReaderGone&) {
    end_by_broken_pipe();
  } catch (const kaustik::Error& error) {
    say("{}", error.what());
    return error.kind() == kaustik::ErrorKind::input ? exit_input : exit_system;
  } catch (const std::bad_alloc&) {
    say("not enough memory\n  remedy: free some, or ask for less: smaller pictures, fewer photons");
  } catch (const std::exception& error) {
    say("{}", error.what());
  }
  return exit_system;
}

}  // namespace

int main(int argc, char** argv) {
  spdlog::set_default_logger(spdlog::stderr_color_mt("kaustik"));
  spdlog::set_pattern("%^%l%$: %v");
  keep_memory();
  // A file that grows over the limit is then an error of the write, not the program's end.
  std::signal(SIGXFSZ, SIG_IGN);
  kaustik::app::prepare_standard_streams();
  int exit_code = kaustik::app::exit_system;
  bool is_told = true, is_output_told = false;
  try {
    return run(argc, argv);
  } catch (const kaustik::app::EndedEarly&) {
    exit_code = told();
  } catch (const kaustik::Error& error) {
    exit_code = told();
    is_output_told = std::string_view(error.what()).find("standard output") != std::string::npos;
  } catch (...) {
    // Printing throws, too, but knows no reason.
    if (!kaustik::app::standard_output_failed()) return told();
    is_told = false;
  }
  if (!kaustik::app::standard_output_failed()) return exit_code;
  try {
    kaustik::app::finish_standard_output();
  } catch (const kaustik::app::ReaderGone&) {
    if (!is_told) told();
  } catch (...) {
    if (!is_output_told) told();
  }
  return exit_code;
}
