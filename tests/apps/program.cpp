#include "tests/apps/program.h"

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <regex>
#include <stdexcept>

namespace kaustik::test {
namespace {

using Clock = std::chrono::steady_clock;

/// The reading end of a pipe and what has come through it.
class Capture {
 public:
  /// Of a terminal, if it is to have columns.
  explicit Capture(int columns = 0) {
    winsize size{};
    size.ws_col = static_cast<unsigned short>(columns);
    size.ws_row = 24;
    const bool is_made = columns > 0 ? ::openpty(&ends_[0], &ends_[1], nullptr, nullptr, &size) == 0
                                     : ::pipe2(ends_, O_CLOEXEC) == 0;
    if (!is_made) throw std::runtime_error("no pipe");
  }
  void resize(int columns) const {
    winsize size{};
    size.ws_col = static_cast<unsigned short>(columns);
    ::ioctl(ends_[0], TIOCSWINSZ, &size);
  }
  ~Capture() {
    ::close(ends_[0]);
    close_writing_end();
  }
  Capture(const Capture&) = delete;
  Capture& operator=(const Capture&) = delete;

  int writing_end() const { return ends_[1]; }
  void close_writing_end() {
    if (ends_[1] >= 0) ::close(ends_[1]);
    ends_[1] = -1;
  }
  pollfd poll_request() const { return {is_open_ ? ends_[0] : -1, POLLIN, 0}; }
  bool is_open() const { return is_open_; }
  void read_some() {
    char buffer[4096];
    const ssize_t count = ::read(ends_[0], buffer, sizeof buffer);
    if (count > 0)
      text.append(buffer, size_t(count));
    else
      is_open_ = false;
  }

  std::string text;

 private:
  int ends_[2] = {-1, -1};
  bool is_open_ = true;
};

void limit(__rlimit_resource resource, std::optional<rlim_t> most) {
  if (!most) return;
  const rlimit both{*most, *most};
  ::setrlimit(resource, &both);
}

[[noreturn]] void become_kaustik(std::vector<char*> argv, const RunOptions& options, int input,
                                 const Capture& out, const Capture& err) {
  const int full = options.full_output ? ::open("/dev/full", O_WRONLY) : -1;
  int unread[2] = {-1, -1};
  if (options.closed_output && ::pipe2(unread, O_CLOEXEC) == 0) ::close(unread[0]);
  ::dup2(options.closed_output ? unread[1] : full >= 0 ? full : out.writing_end(), STDOUT_FILENO);
  ::dup2(err.writing_end(), STDERR_FILENO);
  ::dup2(input, STDIN_FILENO);
  // A background job of a shell has SIGINT ignored, and would hand that down.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGUSR1})
    ::signal(signal, signal == options.ignored_signal ? SIG_IGN : SIG_DFL);
  if (!options.descriptor_3.empty()) {
    const int file = ::open(options.descriptor_3.c_str(), O_WRONLY | O_CREAT, 0666);
    if (file != 3) ::dup2(file, 3);
  }
  limit(RLIMIT_FSIZE, options.file_size_limit);
  limit(RLIMIT_AS, options.memory_limit);
  if (!options.folder.empty() && ::chdir(options.folder.c_str()) != 0) ::_exit(126);
  for (const std::string& variable : options.environment)
    ::putenv(const_cast<char*>(variable.c_str()));
  ::execv(argv[0], argv.data());
  ::_exit(127);
}

}  // namespace

RunResult run_kaustik(const std::vector<std::string>& arguments, const RunOptions& options) {
  std::vector<std::string> words = {KAUSTIK_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  std::FILE* const input = std::tmpfile();
  std::fputs(options.input.c_str(), input);
  std::rewind(input);
  Capture out, err(options.terminal_columns.empty() ? 0 : options.terminal_columns.front());
  size_t resized = 1;
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("cannot fork");
  if (child == 0) become_kaustik(argv, options, ::fileno(input), out, err);
  std::fclose(input);
  out.close_writing_end();
  err.close_writing_end();

  RunResult result;
  bool interrupted = options.interrupt_at.empty();
  bool interrupted_again = options.interrupt_again_at.empty();
  const std::regex interrupt_at(options.interrupt_at), again_at(options.interrupt_again_at);
  std::optional<Clock::time_point> interrupt_time;
  const auto end = Clock::now() + std::chrono::duration<double>(options.timeout_s);
  while (out.is_open() || err.is_open()) {
    if (Clock::now() > end && !result.timed_out) {
      result.timed_out = true;
      ::kill(child, SIGKILL);
    }
    pollfd requests[] = {out.poll_request(), err.poll_request()};
    ::poll(requests, 2, 20);
    if (requests[0].revents != 0) out.read_some();
    if (requests[1].revents != 0) {
      err.read_some();
      if (resized < options.terminal_columns.size())
        err.resize(options.terminal_columns[resized++]);
    }
    if (interrupted && !interrupted_again && std::regex_search(err.text, again_at)) {
      interrupted_again = true;
      for (const int signal : options.later_signals) ::kill(child, signal);
    }
    if (interrupted) continue;
    if (!interrupt_time && std::regex_search(err.text, interrupt_at))
      interrupt_time = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                          std::chrono::duration<double>(options.interrupt_delay_s));
    if (!interrupt_time || Clock::now() < *interrupt_time) continue;
    interrupted = true;
    for (const int signal : options.signals) ::kill(child, signal);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
  result.out = out.text;
  result.err = err.text;
  return result;
}

ProgramTest::ProgramTest() {
  std::string pattern = (std::filesystem::temp_directory_path() / "kaustik_XXXXXX").string();
  if (!::mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder");
  folder_ = pattern;
}

ProgramTest::~ProgramTest() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

void ProgramTest::write(const std::string& name, const std::string& text) const {
  std::filesystem::create_directories(std::filesystem::path(path(name)).parent_path());
  std::ofstream(path(name), std::ios::binary) << text;
}

std::string ProgramTest::contents(const std::string& name) const {
  std::ifstream in(path(name), std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<std::string> ProgramTest::files() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_))
    names.push_back(std::filesystem::relative(entry.path(), folder_).string());
  std::sort(names.begin(), names.end());
  return names;
}

RunResult ProgramTest::run(const std::vector<std::string>& arguments, RunOptions options) const {
  options.folder = folder_.string();
  const RunResult result = run_kaustik(arguments, options);
  EXPECT_FALSE(result.timed_out) << result.err;
  return result;
}

RunResult ProgramTest::run_well(const std::vector<std::string>& arguments) const {
  const RunResult result = run(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return result;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string small_scene(const std::string& integrator) {
  return "<scene version=\"3.0.0\">\n"
         "<default name=\"size\" value=\"24\"/>\n" +
         integrator + R"(
<sensor type="perspective">
  <transform name="to_world"><lookat origin="0,-4,2" target="0,0,0.5" up="0,0,1"/></transform>
  <float name="fov" value="40"/>
  <film type="hdrfilm">
    <integer name="width" value="$size"/><integer name="height" value="$size"/>
  </film>
</sensor>
<shape type="rectangle" id="floor">
  <transform name="to_world"><scale value="3"/></transform>
  <bsdf type="diffuse"><rgb name="reflectance" value="0.6,0.5,0.4"/></bsdf>
</shape>
<shape type="sphere" id="glass">
  <point name="center" x="-0.6" y="0" z="0.6"/><float name="radius" value="0.5"/>
  <bsdf type="dielectric"/>
</shape>
<shape type="sphere" id="metal">
  <point name="center" x="0.6" y="0" z="0.6"/><float name="radius" value="0.5"/>
  <bsdf type="roughconductor"><float name="alpha" value="0.2"/></bsdf>
</shape>
<shape type="rectangle" id="lamp">
  <transform name="to_world">
    <scale value="0.4"/><rotate x="1" angle="180"/><translate z="3"/>
  </transform>
  <emitter type="area"><rgb name="radiance" value="8,8,8"/></emitter>
</shape>
</scene>
)";
}

std::string scene_with(const SceneParts& parts) {
  std::string text = "<scene version=\"3.0.0\">\n" + parts.inside + "\n";
  if (parts.camera)
    text +=
        "<sensor type=\"perspective\"><transform name=\"to_world\">"
        "<lookat origin=\"0,-4,2\" target=\"0,0,0\" up=\"0,0,1\"/></transform>"
        "<film type=\"hdrfilm\"><integer name=\"width\" value=\"8\"/>"
        "<integer name=\"height\" value=\"8\"/></film></sensor>\n";
  if (parts.floor) text += "<shape type=\"rectangle\"/>\n";
  if (parts.lamp)
    text +=
        "<emitter type=\"point\"><point name=\"position\" x=\"0\" y=\"0\" z=\"2\"/></emitter>\n";
  return text + "</scene>\n";
}

}  // namespace kaustik::test
