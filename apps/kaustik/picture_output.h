#pragma once
#include <functional>

#include "failures.h"
#include "file_roles.h"
#include "kaustik/render/finished_picture.h"
#include "kaustik/render/job.h"

namespace kaustik::app {

struct OutputOptions {
  PictureFacts facts;
  bool quiet = false;  ///< says nothing of the files
  /// That the film belongs to; needed for tables alone.
  const Scene* scene = nullptr;
};

/// Whether a picture is as far as the render was to go.
enum class PictureState { finished, ended_early, so_far };

/// Checks, before long work, that the files can be written, each once, and the tone mapping can be
/// made; throws Error.
void check_outputs(const OutputPlan& outputs, FileRoles& roles);

/// For commands that know no scene: throws Error(input) if there is a table of a meter among them.
void refuse_tables(const OutputPlan& outputs);

/// Whether any of the pictures shows more than the light itself: layers, or light that is smoothed
/// by what layers know.
bool needs_layers(const OutputPlan& outputs);

/// Writes the film's picture, or what `picture` makes of it, to all the files of the record's plan,
/// with what is known of it as metadata, and tables of what its meter shows; those that cannot be
/// made or written go to `failures`.
void write_pictures(const Film& film, const RenderRecord& record, const OutputOptions& options,
                    Failures& failures, PictureState state,
                    const std::function<Image()>& picture = {});

/// Writes the picture of the running job, as far as it is, to the files of the plan; what cannot be
/// written is told as a warning. False: there is no sample yet, and nothing was written.
bool write_snapshot(const Job& job, const OutputPlan& outputs);

/// Tells how well the picture is known, on standard error.
void print_errors(const Film& film);

}  // namespace kaustik::app
