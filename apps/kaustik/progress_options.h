#pragma once
#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "file_roles.h"
#include "progress_display.h"

namespace kaustik::app {

/// What a command that takes a while is told of its progress.
struct ProgressOptions {
  std::optional<std::string> progress;  ///< --progress
  std::string file;                     ///< --progress-file; "": none
  bool quiet = false;                   ///< -q
};

/// --progress, --progress-file and -q, which is `quiet_text`.
void add_progress(CLI::App& command, ProgressOptions& options, const std::string& quiet_text);

/// How progress is to be shown; throws Error(input) for what is no way to show it.
ProgressStyle progress_style(const ProgressOptions& options);

/// Begins to tell events() where they go to standard error or another open descriptor; for the time
/// before the scene is read. `roles` are the command's files. Throws Error(input).
void begin_events(const ProgressOptions& options, const FileRoles& roles,
                  const std::string& command, const std::string& scene);
/// The same where they go to a file, which must be none of what the command reads and writes: for
/// the time when all of that is known, before long work.
void begin_event_file(const ProgressOptions& options, FileRoles& roles, const std::string& command,
                      const std::string& scene);

}  // namespace kaustik::app
