#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "kaustik/library/callback_relay.h"
#include "kaustik/library/session_settings.h"

namespace kaustik::v0::details {

/// A session: a job of one scene after the other, each in a thread of its own or in the host's. The
/// thread shares it, so that it lives as long as that runs.
class SessionState : public std::enable_shared_from_this<SessionState> {
 public:
  SessionState(const v0::Scene& scene, const v0::SessionSettings& settings, Callbacks callbacks);
  /// Goes on with a checkpoint of the name `path`.
  SessionState(const v0::Scene& scene, const v0::SessionSettings& settings, Callbacks callbacks,
               Checkpoint checkpoint, const std::string& path);
  /// The thread has ended, or is this one.
  ~SessionState() = default;
  SessionState(const SessionState&) = delete;
  SessionState& operator=(const SessionState&) = delete;

  // As Session has them.
  void start();
  Outcome wait();
  Outcome run();
  void stop();
  void pause() { gate_->close(); }
  void resume() { gate_->open(); }
  bool is_paused() const { return gate_->is_closed(); }
  bool is_running() const { return is_running_; }
  v0::Progress progress() const;
  std::optional<v0::Picture> snapshot(bool with_errors) const;
  v0::Picture picture() const;
  void edit(const v0::Scene& scene);
  void save(const std::string& path) const;
  /// The host lets go of it: stops, and waits unless it is called from a callback.
  void let_go();

 private:
  /// For functions that one thread at a time calls. Throws Error where another one is in one, or
  /// this one in a callback.
  std::unique_lock<std::mutex> owned() const;
  void begin();
  void begin_in_thread();
  void work();
  void render(Job& job);
  void tell_of(const SessionReport& report);
  /// Until the thread has ended. Throws what ended it.
  Outcome result();
  void join();
  void check_ended(const char* what) const;
  std::shared_ptr<Job> job() const;
  JobListener listener();
  void take(const kaustik::Progress& progress);

  v0::SessionSettings settings_;
  v0::Scene scene_;
  Callbacks callbacks_;
  std::shared_ptr<Gate> gate_ = std::make_shared<Gate>();
  CallbackRelay relay_;
  mutable std::mutex owner_;

  // Of the owner, and of the thread while it runs:
  JobSettings next_;                    ///< of the next job
  std::optional<RenderRecipe> recipe_;  ///< of the checkpoint; none: of the settings
  std::thread thread_;
  bool is_started_ = false;
  std::exception_ptr failure_;
  std::optional<JobResult> result_;  ///< of the last job; none: it has failed

  std::atomic<bool> is_running_ = false;
  mutable std::mutex mutex_;  ///< of what follows
  std::shared_ptr<Job> job_;  ///< null: none was started
  v0::Progress progress_;
};

}  // namespace kaustik::v0::details
