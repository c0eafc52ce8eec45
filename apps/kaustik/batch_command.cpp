#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "commands.h"
#include "events.h"
#include "exit_codes.h"
#include "kaustik/base/error.h"
#include "kaustik/base/file.h"
#include "option_values.h"
#include "part_option.h"
#include "screen.h"
#include "signals.h"
#include "standard_streams.h"
#include "study_parts.h"
#include "study_table.h"

namespace kaustik::app {
namespace {

struct BatchOptions {
  std::string study;
  std::optional<std::string> part;
  bool list = false, table = false, force = false;
};

/// Of one part alone, with the events that it tells. Throws what `kaustik render` ends with.
void render(const StudyPart& part) {
  CLI::App program{"", "kaustik"};
  program.require_subcommand(1);
  add_render(program);
  std::vector<std::string> reversed(part.arguments.rbegin(), part.arguments.rend());
  try {
    program.parse(std::move(reversed));
  } catch (const CLI::ParseError& error) {
    throw Error(ErrorKind::input, error.what(), "all options of a render: kaustik render --help");
  }
}

class Batch {
 public:
  explicit Batch(const std::string& file)
      : file_(file), study_(read_study(file)), parts_(parts_of(study_)) {}

  void list() const {
    for (const StudyPart& part : parts_) fmt::print("{}\n", command_line(part.arguments));
  }

  /// Those with these numbers, one after the other; one that fails does not cost the others.
  void run(const PartNumber& share, bool is_forced) {
    make_folder();
    std::vector<std::string> failed;
    size_t count = 0;
    for (size_t i = share.index; i < parts_.size(); i += share.count) {
      const StudyPart& part = parts_[i];
      ++count;
      if (!is_forced && result_of(study_, part)) {
        say("{} of {}: {} is there", i + 1, parts_.size(), part.name);
        continue;
      }
      say("{} of {}: {}", i + 1, parts_.size(), part.name);
      if (!is_rendered(part)) failed.push_back(part.name);
    }
    if (!failed.empty())
      throw Error(failure_,
                  fmt::format("{} of {} variants failed: {}", failed.size(), count,
                              fmt::join(failed, ", ")),
                  "mend what is said above, and give the same command again: what is done stays");
  }

  /// Writes the table, unless parts are missing and it is not asked for.
  void write_table(bool is_asked_for) const {
    const StudyTable table = table_of(study_, parts_);
    const std::string file = study_.folder + "/table.csv";
    if (!table.missing.empty() && !is_asked_for) return;
    if (table.missing.size() == parts_.size())
      throw Error(ErrorKind::input, "no variant is done yet",
                  fmt::format("render them: kaustik batch {}", file_));
    for (const std::string& name : table.missing) warn(fmt::format("{} is not done", name));
    write_text_atomically(file, table.text);
    say("wrote {}", file);
  }

 private:
  void make_folder() const {
    std::error_code failed;
    std::filesystem::create_directories(study_.folder, failed);
    if (failed)
      throw Error(ErrorKind::input,
                  fmt::format("cannot make the folder '{}': {}", study_.folder, failed.message()),
                  "give the study another \"folder\"", place_in(file_));
  }

  /// What goes wrong is told, and kept in failure_. Throws EndedEarly after a signal.
  bool is_rendered(const StudyPart& part) {
    const std::string command = command_file(study_, part);
    std::error_code ignored;
    std::filesystem::remove(command, ignored);
    try {
      render(part);
      // It may have come when the last pass was done.
      if (!first_signal_name().empty()) throw EndedEarly{};
      events().end(0, "");
      write_text_atomically(command, part.command + "\n");
      if (!result_of(study_, part))
        throw Error(ErrorKind::input, "no pass was done, so that there is no value",
                    "give the renders more time");
      return true;
    } catch (const Error& error) {
      fail(error.kind(), error.what());
    } catch (const std::exception& error) {
      fail(ErrorKind::system, error.what());
    }
    return false;
  }
  void fail(ErrorKind kind, const std::string& message) {
    if (kind == ErrorKind::system) failure_ = kind;
    screen().tell(Level::error, message);
    events().end(kind == ErrorKind::input ? exit_input : exit_system, message);
  }

  std::string file_;
  Study study_;
  std::vector<StudyPart> parts_;
  ErrorKind failure_ = ErrorKind::input;  ///< system if one of those that failed is
};

void batch(const BatchOptions& options) {
  Batch work(options.study);
  if (options.list) return work.list();
  if (options.table) return work.write_table(true);
  work.run(options.part ? parse_part(*options.part, most_variants) : PartNumber{}, options.force);
  if (!options.part) work.write_table(false);
}

}  // namespace

void add_batch(CLI::App& program) {
  CLI::App* command =
      program.add_subcommand("batch", "Render the variants of a study: values, cameras, frames.");
  command->footer(
      "A study is a file of JSON:\n"
      "  {\"scene\": \"room.xml\",\n"
      "   \"options\": {\"time\": \"60s\"},\n"
      "   \"factors\": [{\"define\": \"hour\", \"values\": [9, 12, 15]},\n"
      "               {\"set\": \"pane.int_ior\", \"values\": [1.4, 1.6]},\n"
      "               {\"option\": \"camera\", \"values\": [\"desk\", \"door\"]},\n"
      "               {\"define\": \"frame\", \"first\": 1, \"last\": 24}]}\n"
      "Each combination of values is a render. Pictures and table.csv, with all means and meters, "
      "go "
      "to a folder of the study's name. What is done stays, so the same command goes on after a "
      "break. On many machines: --part I/N for each, then --table.");
  auto o = std::make_shared<BatchOptions>();
  takes_files(command->add_option("study", o->study, "File of the study, .json")->required(),
              {"json"});
  auto* part = command
                   ->add_option("--part", o->part,
                                "Render every Nth variant, from variant I on: one of N machines")
                   ->type_name("I/N");
  auto* list =
      command->add_flag("--list", o->list, "Print the render command of each variant; run none")
          ->excludes(part);
  command->add_flag("--table", o->table, "Only write the table, of what is done")
      ->excludes(part)
      ->excludes(list);
  command->add_flag("--force", o->force, "Render again what is done")->excludes(list);
  command->callback([o] { batch(*o); });
}

}  // namespace kaustik::app
