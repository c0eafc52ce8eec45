#pragma once
// Runs the real program and looks at what it leaves.

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace kaustik::test {

#ifdef KAUSTIK_SLOW_BUILD
inline constexpr bool slow_build = true;
inline constexpr double patience_s = 300;
#else
inline constexpr bool slow_build = false;
inline constexpr double patience_s = 60;
#endif

struct RunOptions {
  std::string folder;                    ///< working folder
  std::vector<std::string> environment;  ///< "name=value", added to this program's own
  double timeout_s = patience_s;
  std::optional<rlim_t> file_size_limit;  ///< bytes that a file may have (RLIMIT_FSIZE)
  /// Bytes of address space (RLIMIT_AS); not for programs with sanitizers, which take terabytes.
  std::optional<rlim_t> memory_limit;
  /// Sends these signals, one after the other, this long after standard error holds what this
  /// regular expression describes.
  std::string interrupt_at;
  double interrupt_delay_s = 0;
  std::vector<int> signals = {SIGINT};
  /// Then these, after standard error holds this.
  std::string interrupt_again_at;
  std::vector<int> later_signals = {SIGINT};
  int ignored_signal = 0;  ///< that the program is started with; 0: none
  std::string input;       ///< standard input
  /// Whether standard output is a device that is always full, or a pipe that nobody reads.
  bool full_output = false, closed_output = false;
  /// File that the program is started with as descriptor 3, for writing; "": none.
  std::string descriptor_3;
  /// Standard error is a terminal of so many columns, from the second number on of so many after
  /// each read of its text; empty: a pipe.
  std::vector<int> terminal_columns;
};

struct RunResult {
  int exit_code = -1;  ///< −1: ended by a signal
  int signal = 0;      ///< that ended it; 0: none
  bool timed_out = false;
  std::string out, err;
};

/// Runs `kaustik` with these arguments and waits for its end; kills it after the timeout.
RunResult run_kaustik(const std::vector<std::string>& arguments, const RunOptions& options);

/// A folder of its own for each test, in which the program runs.
class ProgramTest : public ::testing::Test {
 protected:
  ProgramTest();
  ~ProgramTest() override;

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const std::string& text) const;
  /// Empty if there is no such file.
  std::string contents(const std::string& name) const;
  bool exists(const std::string& name) const { return std::filesystem::exists(path(name)); }
  /// Sorted names of all that is in the folder.
  std::vector<std::string> files() const;

  RunResult run(const std::vector<std::string>& arguments, RunOptions options = {}) const;
  /// The same, and expects success.
  RunResult run_well(const std::vector<std::string>& arguments) const;

 private:
  std::filesystem::path folder_;
};

bool contains(const std::string& text, const std::string& part);

/// A scene that renders in a moment: a diffuse floor, a glass and a glossy sphere under a lamp.
/// Width and height can be changed by -D size=….
std::string small_scene(const std::string& integrator = "<integrator type=\"path\"/>");

/// A scene of a camera, a floor and a point light, with `inside` on line 2. The camera, the floor,
/// the light may be left out.
struct SceneParts {
  std::string inside;
  bool camera = true, floor = true, lamp = true;
};
std::string scene_with(const SceneParts& parts);

}  // namespace kaustik::test
