#include "kaustik/session.h"

#include "kaustik/library/boundary.h"
#include "kaustik/library/session_state.h"

namespace kaustik::v0 {
namespace {

using details::SessionState;

/// The session may have been moved from.
SessionState& existing(const std::shared_ptr<SessionState>& state) {
  if (!state) throw misuse("the session was moved to another one", "ask that one");
  return *state;
}

void release(std::shared_ptr<SessionState> state) {
  if (state) state->let_go();
}

}  // namespace

Session::Session(std::shared_ptr<SessionState> state) : state_(std::move(state)) {}

Session::Session(const Scene& scene, const SessionSettings& settings, Callbacks callbacks)
    : state_(guarded(
          [&] { return std::make_shared<SessionState>(scene, settings, std::move(callbacks)); })) {}

Session Session::load(const std::string& path, const Scene& scene, const SessionSettings& settings,
                      Callbacks callbacks) {
  return guarded([&] {
    return Session(std::make_shared<SessionState>(scene, settings, std::move(callbacks),
                                                  read_checkpoint(path), path));
  });
}

Session::~Session() { release(std::move(state_)); }
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&& other) noexcept {
  if (this != &other) release(std::exchange(state_, std::move(other.state_)));
  return *this;
}

void Session::start() {
  guarded([&] { existing(state_).start(); });
}

Outcome Session::wait() {
  // A callback may destroy the session.
  const auto kept = state_;
  return guarded([&] { return existing(kept).wait(); });
}

Outcome Session::run() {
  const auto kept = state_;
  return guarded([&] { return existing(kept).run(); });
}

void Session::stop() noexcept {
  if (state_) state_->stop();
}
void Session::pause() noexcept {
  if (state_) state_->pause();
}
void Session::resume() noexcept {
  if (state_) state_->resume();
}
bool Session::is_paused() const noexcept { return state_ && state_->is_paused(); }
bool Session::is_running() const noexcept { return state_ && state_->is_running(); }

Progress Session::progress() const {
  return guarded([&] { return existing(state_).progress(); });
}
std::optional<Picture> Session::snapshot(bool with_errors) const {
  const auto kept = state_;
  return guarded([&] { return existing(kept).snapshot(with_errors); });
}
Picture Session::picture() const {
  return guarded([&] { return existing(state_).picture(); });
}
void Session::edit(const Scene& scene) {
  guarded([&] { existing(state_).edit(scene); });
}
void Session::save(const std::string& path) const {
  guarded([&] { existing(state_).save(path); });
}

}  // namespace kaustik::v0
