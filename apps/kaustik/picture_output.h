#pragma once
#include "kaustik/render/checkpoint.h"

namespace kaustik::app {

struct OutputOptions {
  int threads = 0;               ///< for smoothing; 0: all
  bool quiet = false;            ///< says nothing of the files
  bool incomplete_pass = false;  ///< the film holds only a part of its one pass
};

/// Checks, before long work, that the files can be written and the tone mapping can be made; throws
/// Error.
void check_outputs(const OutputPlan& outputs);

/// Writes the film's picture to all the files of the record's plan, with what is known of it as
/// metadata. Throws Error.
void write_pictures(const Film& film, const RenderRecord& record, const OutputOptions& options);

/// Tells how well the picture is known, on standard error.
void print_errors(const Film& film);

}  // namespace kaustik::app
