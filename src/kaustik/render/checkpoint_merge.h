#pragma once
// Checkpoints of different passes put together.

#include <string>
#include <vector>

#include "kaustik/render/checkpoint.h"

namespace kaustik {

/// The passes of both, in `whole`, with the record of the part whose passes begin first, so that
/// the order of parts makes no difference; where they were to write different images, it names
/// none. Of their lessons it keeps those of more passes. Throws Error(input), at `path`, where part
/// and whole have a pass in common, or are of different scenes, integrators, settings, seeds or
/// samples per pass. `whole_path` is for messages.
void merge_checkpoint(Checkpoint& whole, const std::string& whole_path, const Checkpoint& part,
                      const std::string& path);

/// The same of a file, of which a few rows are in memory at a time. If it throws, `whole` is of no
/// use any more unless the file was refused for its checksum or what it belongs to.
void merge_checkpoint_file(Checkpoint& whole, const std::string& whole_path,
                           const std::string& path);

/// What files of passes are together, as their beginnings tell.
struct MergedPasses {
  PassSet passes;
  PassDivision division;  ///< that all of them are parts of; else not divided
};
/// Reads these beginnings. Throws Error(input) with all that does not belong together, is not of
/// this version of the program, or is damaged, each at its path; merging may find more.
MergedPasses check_parts(const std::vector<std::string>& paths, const std::string& program);

}  // namespace kaustik
