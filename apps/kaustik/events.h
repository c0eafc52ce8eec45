#pragma once
// Progress for programs: lines of JSON, one for each event. docs/guides/progress.md tells their
// fields.

#include <memory>
#include <string>

#include "event_stream.h"
#include "kaustik/render/job.h"

namespace kaustik::app {

/// The events of a command. Without a stream nothing is told.
class Events {
 public:
  /// Begins with what is done, with which scene. On standard error messages become events, too.
  void begin(std::unique_ptr<EventStream> stream, const std::string& command,
             const std::string& scene);
  bool are_told() const { return stream_ != nullptr; }
  /// Whether nothing else may be shown on standard error.
  bool are_on_screen() const { return is_on_screen_; }

  /// When a pass is finished, else once a second.
  void progress(const Progress& progress);
  /// Of work without passes.
  void progress(double fraction, double elapsed_s);
  /// A file was written; `facts` tell what it shows.
  void written(const std::string& file, const JsonObject& facts);
  /// What a meter has measured.
  void measured(const JsonObject& facts);
  /// How the command's work ended, for end().
  void result(const std::string& reason, const JsonObject& facts);
  /// The last line; `message` tells what went wrong.
  void end(int exit_code, const std::string& message);

 private:
  std::unique_ptr<EventStream> stream_;
  bool is_on_screen_ = false;
  double last_told_s_ = -1e9;
  uint32_t passes_told_ = 0;
  std::string reason_ = "done";
  JsonObject facts_;
};

/// The program's only ones.
Events& events();

}  // namespace kaustik::app
