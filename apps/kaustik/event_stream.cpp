#include "event_stream.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <system_error>

#include "kaustik/base/error.h"
#include "screen.h"

namespace kaustik::app {
namespace {

constexpr const char* descriptor_prefix = "fd:";
constexpr const char* event_option = "command line: --progress-file";

int open_file(const std::string& path) {
  // A named pipe that nobody reads would be waited for.
  const int descriptor =
      ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NONBLOCK, 0666);
  if (descriptor < 0) {
    const bool lacks_reader = errno == ENXIO;
    throw Error(ErrorKind::input,
                fmt::format("cannot write progress to '{}': {}", path,
                            lacks_reader ? "nobody reads this pipe"
                                         : std::generic_category().message(errno)),
                lacks_reader ? "start what reads it first"
                             : "give a file in a folder that can be written to",
                place_in(event_option));
  }
  ::fcntl(descriptor, F_SETFL, ::fcntl(descriptor, F_GETFL) & ~O_NONBLOCK);
  return descriptor;
}

int numbered_descriptor(const std::string& target) {
  int descriptor = -1;
  const char *const begin = target.data() + 3, *const end = target.data() + target.size();
  const auto [last, code] = std::from_chars(begin, end, descriptor);
  if (code != std::errc{} || last != end || descriptor < 0)
    throw Error(ErrorKind::input, fmt::format("cannot read the descriptor '{}'", target),
                "write a number behind it: fd:3; a file that is called so is ./" + target,
                place_in(event_option));
  const int flags = ::fcntl(descriptor, F_GETFL);
  if (flags < 0 || (flags & O_ACCMODE) == O_RDONLY)
    throw Error(ErrorKind::input, fmt::format("descriptor {} is not open for writing", descriptor),
                fmt::format("open it in the shell: kaustik … {}>progress.jsonl", descriptor),
                place_in(event_option));
  return descriptor;
}

}  // namespace

bool names_descriptor(const std::string& target) { return target.starts_with(descriptor_prefix); }

EventStream::EventStream(const std::string& target) : name_(target) {
  is_own_ = !names_descriptor(target);
  descriptor_ = is_own_ ? open_file(target) : numbered_descriptor(target);
}

EventStream::EventStream() : name_("standard error"), descriptor_(STDERR_FILENO) {}

EventStream::~EventStream() {
  if (is_own_ && descriptor_ >= 0) ::close(descriptor_);
}

bool EventStream::is_same_as(int descriptor) const {
  struct stat a {
  }, b{};
  if (descriptor_ == descriptor) return true;
  return ::fstat(descriptor_, &a) == 0 && ::fstat(descriptor, &b) == 0 && a.st_dev == b.st_dev &&
         a.st_ino == b.st_ino && !(S_ISCHR(a.st_mode) && !::isatty(descriptor));
}

void EventStream::send(const JsonObject& event, Need need) {
  const std::lock_guard lock(mutex_);
  if (descriptor_ < 0) return;
  const std::string line = event.text() + "\n";
  // A pipe that is ready takes 4096 bytes, which is more than a line has unless names are very
  // long.
  pollfd request{descriptor_, POLLOUT, 0};
  if (::poll(&request, 1, need == Need::lasting ? 1000 : 0) == 0) return;
  size_t written = 0;
  while (written < line.size()) {
    const ssize_t count = ::write(descriptor_, line.data() + written, line.size() - written);
    if (count >= 0)
      written += size_t(count);
    else if (errno == EAGAIN && written == 0)
      return;
    else if (errno != EINTR && errno != EAGAIN)
      return give_up(std::generic_category().message(errno));
  }
}

void EventStream::give_up(const std::string& why) {
  const bool is_standard_error = descriptor_ == STDERR_FILENO;
  if (is_own_) ::close(descriptor_);
  descriptor_ = -1;
  if (!is_standard_error) warn(fmt::format("no more progress in '{}': {}", name_, why));
}

}  // namespace kaustik::app
