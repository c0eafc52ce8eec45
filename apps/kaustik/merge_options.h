#pragma once
#include <string>
#include <vector>

#include "file_roles.h"

namespace kaustik::app {

/// What `kaustik merge` is told.
struct MergeOptions {
  std::vector<std::string> inputs, outputs;
  bool force = false;
  bool incomplete = false;  ///< a picture of some parts will do
  bool consume = false;     ///< inputs are removed when what they hold is written
};

/// An output that may replace neither its parts nor what somebody else has computed; `kind` is what
/// it is. Throws Error(input).
void add_merged_output(FileRoles& roles, const std::string& path, const FileKind& kind, bool force);

/// Puts together the passes of checkpoints, of which one film at a time is in memory, and writes
/// checkpoints and pictures of them. Throws Error of all that is wrong.
void merge_passes(const MergeOptions& options, FileRoles& roles);

}  // namespace kaustik::app
