#pragma once
#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>

#include "kaustik/live/snapshot.h"
#include "kaustik/render/job.h"

namespace kaustik {

struct EngineSettings {
  /// As of a render; the gate is the engine's own. Views need no layers.
  SessionSettings session;
  BuildOptions build;
  RenderRecipe recipe;  ///< changes that are made to every description
  /// Least time between two snapshots of the same kind, s. Those of another kind come at once.
  double snapshot_interval_s = 0.1;
};

enum class EngineState : uint8_t {
  idle,       ///< nothing was started yet, or it was stopped
  building,   ///< a scene is built
  rendering,  ///<
  paused,     ///< rendering, but for its threads resting
  finished,   ///< all that was asked for is done
  failed      ///< see EngineStatus::failure
};

struct EngineStatus {
  EngineState state = EngineState::idle;
  uint64_t revision = 0;  ///< of what is rendered
  Progress progress;      ///< of rendering it, the last that was told
  /// Why the last description was refused, or what ended rendering; null: nothing.
  std::exception_ptr failure;
};

/// Renders a scene that changes, for those who watch: descriptions go in, snapshots come out. All
/// functions may be called from any thread and return at once, but for those that wait. Commands
/// are done in their order, in a thread of the engine's; of several edits that wait only the last
/// counts.
///
/// An edit that is refused harms nothing: rendering of the one before goes on, with all its passes.
class Engine {
 public:
  explicit Engine(EngineSettings settings = {}, Messages messages = {});
  /// Stops, and waits.
  ~Engine();
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  /// Renders this from now on, once it was started. The objects must not change from here on.
  /// Returns the revision, from 1 on.
  uint64_t edit(Description description);
  /// Begins to render. Where it was stopped, or has finished, it begins anew. Throws
  /// std::logic_error if there was no edit.
  void start();
  void pause();
  void resume();
  /// Ends rendering; the last snapshot stays.
  void stop();

  EngineStatus status() const;
  /// The newest; null: there is none yet.
  std::shared_ptr<const Snapshot> snapshot() const;
  /// The newest, once there is one with a larger number than that, or when the time is over: then
  /// null.
  std::shared_ptr<const Snapshot> wait_for_snapshot(uint64_t after,
                                                    std::chrono::milliseconds most) const;
  /// Until it neither builds nor renders, and no command waits. False when the time was over
  /// before.
  bool wait_until_done(std::chrono::milliseconds most) const;

 private:
  /// What is wanted: commands write it, the engine's thread makes it so.
  struct Wanted {
    std::shared_ptr<const Description> description;
    uint64_t revision = 0, start = 0;
    bool runs = false, is_paused = false, ends = false;
  };
  /// One description that is rendered.
  struct Run {
    uint64_t revision = 0;
    std::shared_ptr<Gate> gate;
    std::unique_ptr<Job> job;
  };

  void work();
  /// Builds what is wanted and, if that went well, renders it in the place of the run before.
  void take(const Wanted& wanted);
  std::unique_ptr<Run> prepared(const Wanted& wanted);
  void begin(std::unique_ptr<Run> run);
  void end_run();
  bool has_work() const;
  /// Of the run before, which goes on as it was.
  EngineState state_after_refusal(EngineState before) const;
  // Called by the job's threads:
  void progressed(const Run& run, const Progress& progress);
  void pass_done(const Run& run, uint32_t passes);
  void ended(const Run& run, const std::exception_ptr& failure);
  /// Shares the picture as it is, if it is time or `is_last`.
  void publish(const Run& run, bool is_last);

  EngineSettings settings_;
  Messages messages_;

  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;  ///< anything below
  Wanted wanted_;
  EngineStatus status_;
  uint64_t taken_revision_ = 0, taken_start_ = 0;
  bool is_busy_ = false;        ///< the thread is doing what was wanted
  const Run* shown_ = nullptr;  ///< whose pictures and progress count
  std::shared_ptr<Gate> gate_;  ///< of the run
  std::shared_ptr<const Snapshot> snapshot_;
  std::chrono::steady_clock::time_point published_;

  std::unique_ptr<Run> run_;  ///< of the thread
  std::thread thread_;
};

}  // namespace kaustik
