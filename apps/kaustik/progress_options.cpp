#include "progress_options.h"

#include <unistd.h>

#include <algorithm>
#include <memory>
#include <string_view>
#include <vector>

#include "events.h"
#include "kaustik/base/error.h"
#include "kaustik/base/file.h"
#include "option_values.h"
#include "screen.h"

namespace kaustik::app {
namespace {

const std::vector<std::string> progress_names = {"auto", "bar", "plain", "json", "none"};

/// What an earlier command has left may be replaced.
bool is_event_file(const std::string& path) {
  const std::string_view begin = "{\"event\":";
  const std::vector<uint8_t> start = read_file_start(path, begin.size());
  return std::equal(start.begin(), start.end(), begin.begin(), begin.end());
}

bool wants_events_on_screen(const ProgressOptions& options) {
  return options.progress == "json" && options.file.empty();
}

std::unique_ptr<EventStream> opened(const std::string& target, const FileRoles& roles) {
  auto stream = std::make_unique<EventStream>(target);
  if (stream->is_same_as(STDOUT_FILENO) && roles.writes_standard_output())
    throw Error(ErrorKind::input, "the picture and its progress would both go to standard output",
                "send one of them elsewhere: --progress-file FILE",
                place_in("command line: --progress-file"));
  return stream;
}

}  // namespace

void add_progress(CLI::App& command, ProgressOptions& options, const std::string& quiet_text) {
  takes_words(command.add_option(
                  "--progress", options.progress,
                  "Progress on standard error: a bar, a plain line now and then, or json: lines of "
                  "JSON for programs, with the messages [auto: bar on a terminal, else plain]"),
              progress_names);
  takes_files(command.add_option("--progress-file", options.file,
                                 "Write progress as lines of JSON to this file, or to an open "
                                 "descriptor such as fd:3; beside --progress"),
              {});
  command.add_flag("-q,--quiet", options.quiet, quiet_text);
}

ProgressStyle progress_style(const ProgressOptions& options) {
  const std::string style = options.progress.value_or(options.quiet ? "none" : "auto");
  if (style == "auto") return screen().is_terminal() ? ProgressStyle::bar : ProgressStyle::plain;
  if (style == "bar") return ProgressStyle::bar;
  if (style == "plain") return ProgressStyle::plain;
  if (style == "json" || style == "none") return ProgressStyle::none;
  throw Error(ErrorKind::input, "there is no progress '" + style + "'",
              suggest(style, progress_names), place_in("command line: --progress"));
}

void begin_events(const ProgressOptions& options, const FileRoles& roles,
                  const std::string& command, const std::string& scene) {
  progress_style(options);
  if (wants_events_on_screen(options))
    events().begin(std::make_unique<EventStream>(), command, scene);
  else if (names_descriptor(options.file))
    events().begin(opened(options.file, roles), command, scene);
}

void begin_event_file(const ProgressOptions& options, FileRoles& roles, const std::string& command,
                      const std::string& scene) {
  if (options.file.empty() || names_descriptor(options.file)) return;
  roles.writes_stream(options.file, {"a file of progress", is_event_file});
  roles.check();
  events().begin(opened(options.file, roles), command, scene);
}

}  // namespace kaustik::app
