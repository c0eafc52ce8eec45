#pragma once
// The signals that the program listens to.

#include <signal.h>

#include <array>
#include <stop_token>
#include <string>
#include <thread>

namespace kaustik::app {

/// Turns the first Ctrl-C (SIGINT), SIGTERM or SIGHUP into a stop request; a second one, of
/// whichever, ends the program at once. The same one again within a moment is the first: some send
/// it to the process and to its group. What is ignored stays so: SIGHUP under
/// nohup, SIGINT of a script's background jobs.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  std::stop_token token() const { return source_.get_token(); }

 private:
  static constexpr std::array<int, 3> signals_ = {SIGINT, SIGTERM, SIGHUP};
  std::array<struct sigaction, signals_.size()> before_{};
  std::stop_source source_;
  std::jthread watcher_;
};

/// The signal that an InterruptGuard has seen first: "SIGTERM"; "" if none.
std::string first_signal_name();

/// From now on SIGUSR1 asks for the picture, in place of ending the program, unless it is ignored;
/// and it is noticed that the program goes on after a halt (SIGCONT).
void listen_for_requests();
/// Whether SIGUSR1 has come since this was asked last.
bool take_picture_request();
/// Whether the program was halted since this was asked last: others have written to the terminal.
bool take_continuation();

}  // namespace kaustik::app
