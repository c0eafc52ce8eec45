#pragma once
#include <string>

#include "kaustik/render/job.h"

namespace kaustik::app {

/// Whether a file with contents is there.
bool is_begun(const std::string& checkpoint);

/// Lets the job, whose settings are those of the command line, go on with the checkpoint, which is
/// kept up to date. Its limit of time is of all tries together, unless it renders a part. Throws
/// Error(input), at the file, if it is none, or not of the same seed, first pass, lessons and
/// program; the job does so if it is of another scene, part, or samples per pass.
void go_on_with(const std::string& checkpoint, JobSettings& job);

}  // namespace kaustik::app
