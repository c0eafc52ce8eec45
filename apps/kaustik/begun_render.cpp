#include "begun_render.h"

#include <fmt/format.h>

#include <filesystem>

#include "kaustik/base/version.h"
#include "kaustik/render/program_version.h"
#include "kaustik/render/resume.h"

namespace kaustik::app {
namespace {

[[noreturn]] void refuse(const std::string& checkpoint, const std::string& difference) {
  throw Error(ErrorKind::input, "it is not of this command: " + difference,
              "repeat the command that began it, or choose another checkpoint",
              place_in(checkpoint));
}

void check_lessons(const std::string& checkpoint, const RenderRecipe& was,
                   const std::optional<StoredLessons>& learned) {
  const uint64_t asked = learned ? digest_of(learned->lessons) : 0;
  if (was.lessons == asked) return;
  refuse(checkpoint, was.lessons == 0 ? "its passes were rendered without --learned"
                     : asked == 0     ? "its passes were rendered with --learned"
                                      : "its passes were rendered with other lessons");
}

void check_passes(const std::string& checkpoint, const StopPlan& was,
                  const SessionSettings& asked) {
  // The job compares parts.
  if (asked.part) return;
  if (was.division.is_divided()) refuse(checkpoint, "it is one of several parts");
  if (was.first_pass != asked.first_pass)
    refuse(checkpoint,
           fmt::format("its passes begin with {}, not with {}", was.first_pass, asked.first_pass));
}

}  // namespace

bool is_begun(const std::string& checkpoint) {
  std::error_code failed;
  const auto size = std::filesystem::file_size(checkpoint, failed);
  return !failed && size > 0;
}

void go_on_with(const std::string& checkpoint, JobSettings& job) {
  Checkpoint begun = read_checkpoint(checkpoint);
  const RenderRecord& was = begun.record;
  check_program(checkpoint, was.program, KAUSTIK_VERSION);
  if (was.recipe.seed != job.session.seed)
    refuse(checkpoint, fmt::format("its seed is {}, not {}", was.recipe.seed, job.session.seed));
  check_passes(checkpoint, was.plan, job.session);
  check_lessons(checkpoint, was.recipe, job.learned);
  // The checkpoint has the lessons.
  if (job.learned && !(job.session.passes && job.session.samples_per_pixel))
    job.session.samples_per_pass = job.learned->samples_per_pass;
  job.learned.reset();
  job.record.recipe.lessons = was.recipe.lessons;
  job.record.seconds = was.seconds;
  // Parts have their time anew in each try: it only ends them early.
  if (!job.session.part) keep_to_time(job.session, job.record.plan.seconds, begun);
  job.begun = std::move(begun);
  job.begun_path = checkpoint;
}

}  // namespace kaustik::app
