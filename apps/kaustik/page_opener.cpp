#include "page_opener.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "environment_variable.h"

namespace kaustik::app {
namespace {

/// Starts a program that is not waited for, whose messages nobody sees. False: it cannot be had.
bool start(const char* program, const std::string& argument) {
  const pid_t child = ::fork();
  if (child < 0) return false;
  if (child == 0) {
    // Another fork, so that nobody has to wait for what it starts.
    ::setsid();
    const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
    for (const int stream : {0, 1, 2}) ::dup2(nothing, stream);
    if (::fork() != 0) ::_exit(0);
    ::execlp(program, program, argument.c_str(), nullptr);
    ::_exit(127);
  }
  int status = 0;
  return ::waitpid(child, &status, 0) == child && status == 0;
}

}  // namespace

PageOpener::~PageOpener() {
  std::error_code ignored;
  if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
}

bool PageOpener::is_of_use() {
  const bool has_desktop =
      !environment_variable("DISPLAY").empty() || !environment_variable("WAYLAND_DISPLAY").empty();
  return has_desktop && ::isatty(STDOUT_FILENO);
}

bool PageOpener::open(const std::string& url) {
  const std::string runtime = environment_variable("XDG_RUNTIME_DIR");
  std::string folder = (runtime.empty() ? std::string("/tmp") : runtime) + "/kaustik-view-XXXXXX";
  // A folder of this user's alone.
  if (!::mkdtemp(folder.data())) return false;
  folder_ = folder;
  const std::string file = folder_ + "/open.html";
  std::ofstream page(file);
  page << fmt::format(
      "<!doctype html><meta charset=\"utf-8\"><meta http-equiv=\"refresh\" content=\"0; url={0}\">"
      "<title>Kaustik</title><a href=\"{0}\">{0}</a>\n",
      url);
  page.close();
  return page && start("xdg-open", file);
}

}  // namespace kaustik::app
