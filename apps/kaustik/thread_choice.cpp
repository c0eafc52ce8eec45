#include "thread_choice.h"

#include <fmt/format.h>

#include "screen.h"

namespace kaustik::app {
namespace {

/// Launchers of parallel programs bind small jobs to one processor each, and nothing else tells.
void warn_of_one_processor(const Processors& processors) {
  warn(
      fmt::format("this process is bound to 1 of {} cores, so it renders with one thread\n"
                  "  remedy: if that is not meant, start it by: srun --cpu-bind=none …, mpirun "
                  "--bind-to none …; if it is, --threads 1 says so",
                  processors.of_machine));
}

}  // namespace

std::string text_of(const Processors& processors) {
  const int usable = processors.usable();
  if (usable >= processors.of_machine) return {};
  std::string reason = fmt::format("the process is bound to {}", processors.bound);
  if (processors.quota < processors.bound)
    reason = fmt::format("its control groups allow the time of {:.3g}", processors.quota);
  return fmt::format("{} of {} cores: {}", usable, processors.of_machine, reason);
}

int usable_threads(int asked, bool is_quiet) {
  const Processors here = processors();
  const int usable = here.usable();
  if (here.bound == 1 && here.of_machine > 1 && asked != 1)
    warn_of_one_processor(here);
  else if (const std::string text = text_of(here); !text.empty() && asked == 0 && !is_quiet)
    note("uses " + text);
  if (asked <= usable) return asked;
  warn(fmt::format("--threads {}: this process may run {} at a time, so that many are used", asked,
                   usable));
  return usable;
}

}  // namespace kaustik::app
