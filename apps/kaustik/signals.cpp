#include "signals.h"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <ctime>

namespace kaustik::app {
namespace {

/// The first signal and when it came, in one number so that no other comes in between: µs · 256 +
/// signal; 0: none yet.
std::atomic<int64_t> first_signal = 0;
static_assert(std::atomic<int64_t>::is_always_lock_free);
std::atomic<bool> picture_is_asked_for = false, has_continued = false;
static_assert(std::atomic<bool>::is_always_lock_free);

constexpr int64_t same_moment_us = 200'000;

int64_t now_us() {
  timespec time{};
  ::clock_gettime(CLOCK_MONOTONIC, &time);
  return int64_t(time.tv_sec) * 1'000'000 + time.tv_nsec / 1000;
}

void on_interrupt(int signal) {
  const int64_t now = now_us();
  int64_t first = 0;
  // Otherwise `first` is what came before.
  if (first_signal.compare_exchange_strong(first, now << 8 | signal)) return;
  if ((first & 255) == signal && now - (first >> 8) < same_moment_us) return;
  // It is delivered when this returns.
  ::signal(signal, SIG_DFL);
  ::raise(signal);
}

void on_picture_request(int) { picture_is_asked_for = true; }
void on_continuation(int) { has_continued = true; }

/// Unless the program was started with the signal ignored.
void listen_to(int signal, void (*handler)(int)) {
  struct sigaction before {};
  ::sigaction(signal, nullptr, &before);
  if (before.sa_handler == SIG_IGN) return;
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  ::sigaction(signal, &action, nullptr);
}

}  // namespace

InterruptGuard::InterruptGuard() {
  first_signal = 0;
  struct sigaction action {};
  action.sa_handler = on_interrupt;
  action.sa_flags = SA_RESTART;
  for (const int signal : signals_) ::sigaddset(&action.sa_mask, signal);
  for (size_t i = 0; i < signals_.size(); ++i) {
    ::sigaction(signals_[i], nullptr, &before_[i]);
    if (before_[i].sa_handler != SIG_IGN) ::sigaction(signals_[i], &action, nullptr);
  }
  watcher_ = std::jthread([this](std::stop_token ended) {
    while (!ended.stop_requested()) {
      if (first_signal != 0) source_.request_stop();
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  });
}

InterruptGuard::~InterruptGuard() {
  for (size_t i = 0; i < signals_.size(); ++i) ::sigaction(signals_[i], &before_[i], nullptr);
}

std::string first_signal_name() {
  switch (first_signal & 255) {
    case SIGINT:
      return "SIGINT";
    case SIGTERM:
      return "SIGTERM";
    case SIGHUP:
      return "SIGHUP";
    default:
      return {};
  }
}

void listen_for_requests() {
  listen_to(SIGUSR1, on_picture_request);
  listen_to(SIGCONT, on_continuation);
}

bool take_picture_request() { return picture_is_asked_for.exchange(false); }

bool take_continuation() { return has_continued.exchange(false); }

}  // namespace kaustik::app
