#include "standard_streams.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <iostream>
#include <system_error>

#include "kaustik/base/error.h"

namespace kaustik::app {
namespace {

constexpr size_t most_scene_bytes = size_t{512} << 20;

bool reader_is_gone() {
  pollfd request{STDOUT_FILENO, POLLOUT, 0};
  return ::poll(&request, 1, 0) == 1 && (request.revents & POLLERR) != 0;
}

[[noreturn]] void throw_output_failed(int reason) {
  if (reason == EPIPE || (reason == 0 && reader_is_gone())) throw ReaderGone{};
  std::string why;
  if (reason != 0) why = ": " + std::error_code(reason, std::generic_category()).message();
  throw Error(ErrorKind::system, "cannot write to standard output" + why,
              "free some space, or send it elsewhere");
}

}  // namespace

void prepare_standard_streams() {
  // What was closed fails when it is used, and swallows nothing.
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF)
      (void)::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  ::signal(SIGPIPE, SIG_IGN);
}

bool standard_output_failed() { return std::ferror(stdout) != 0; }

void finish_standard_output() {
  std::cout.flush();
  const int reason = std::fflush(stdout) != 0 ? errno : 0;
  if (reason == 0 && !standard_output_failed()) return;
  throw_output_failed(reason);
}

void end_by_broken_pipe() {
  ::signal(SIGPIPE, SIG_DFL);
  ::raise(SIGPIPE);
}

bool is_standard_stream(const std::string& name) {
  if (name == "-") return true;
  const size_t colon = name.find(':');
  return colon != std::string::npos && name.substr(colon) == ":-" &&
         name.find('/') == std::string::npos;
}

std::string read_standard_input() {
  std::string text;
  char buffer[1 << 16];
  while (const size_t count = std::fread(buffer, 1, sizeof buffer, stdin)) {
    text.append(buffer, count);
    if (text.size() > most_scene_bytes)
      throw Error(ErrorKind::input, "standard input has more than 512 MiB",
                  "keep meshes in files of their own", place_in("standard input"));
  }
  if (std::ferror(stdin) != 0)
    throw Error(ErrorKind::system, "standard input cannot be read", "give the name of a file");
  return text;
}

void write_standard_output(std::span<const uint8_t> bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size() &&
      std::fflush(stdout) == 0)
    return;
  throw_output_failed(errno);
}

}  // namespace kaustik::app
