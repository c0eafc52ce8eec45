#pragma once
#include <array>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "kaustik/live/snapshot.h"
#include "kaustik/render/job.h"

namespace kaustik {

/// By photons, which are kept while only the camera moves, without gathering: caustics stay, and
/// diffuse indirect light is blotchy.
RenderRecipe recipe_of_moving_views();

struct EngineSettings {
  /// As of a render; the gate is the engine's own. Films of views that move have no layers.
  SessionSettings session;
  BuildOptions build;
  RenderRecipe recipe;  ///< changes that are made to every description
  /// Those that are made in their place until nothing was edited for `rest_s`, for integrators that
  /// have a picture sooner (recipe_of_moving_views()); and until a whole pass of that was seen, 10
  /// s at most: what they keep of light is for the next move. Absent: `recipe`.
  std::optional<RenderRecipe> moving;
  double rest_s = 1;
  /// Least time between two snapshots of the same kind, s. Those of another kind come at once.
  double snapshot_interval_s = 0.1;
  /// Whether snapshots show all that images with layers do, if films hold it. Without they are made
  /// much sooner; look_at_film() tells of the rest who asks.
  bool layers_in_snapshots = true;
};

enum class EngineState : uint8_t {
  idle,       ///< nothing was started yet, or it was stopped
  building,   ///< a scene is built
  rendering,  ///< passes are taken
  paused,     ///< passes are to be taken, but threads rest
  finished,   ///< all that was asked for is done
  failed      ///< see EngineStatus::failure and refusal
};

struct EngineStatus {
  EngineState state = EngineState::idle;
  uint64_t revision = 0;                ///< of what is rendered
  Progress progress;                    ///< of rendering it, the last that was told
  std::vector<RegionProgress> regions;  ///< of the same
  std::exception_ptr failure;  ///< what ended rendering otherwise than it should; null: nothing
  /// Why a description was refused, and its revision; null once a later one is rendered.
  std::exception_ptr refusal;
  uint64_t refused_revision = 0;
};

/// Renders a scene that changes, for those who watch: descriptions go in, snapshots come out. All
/// functions may be called from any thread and return at once, but for those that wait. A thread of
/// the engine's builds scenes; of several edits that come meanwhile only the last counts. While
/// edits keep coming, each that is taken gets a picture, or a tenth of a second (while views move,
/// a second).
///
/// An edit that is refused harms nothing: rendering of the one before goes on, with all its passes.
///
/// Messages come from threads of the engine's and of its jobs, and must not destroy the engine;
/// what they throw counts as a refusal or ends rendering.
class Engine {
 public:
  explicit Engine(EngineSettings settings = {}, Messages messages = {});
  /// Stops, and waits.
  ~Engine();
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  /// Renders this from now on, once it was started. Takes a copy of its objects when it is called.
  /// Returns the revision, from 1 on.
  uint64_t edit(const Description& description);
  /// Begins to render. Where it was stopped, or has finished, it begins anew; else nothing changes.
  /// Throws std::logic_error if there was no edit.
  void start();
  /// Lasts until resume(), whatever is started, stopped and edited. A light pass is finished first.
  void pause();
  void resume();
  /// Ends rendering; the last snapshot stays.
  void stop();

  /// Session::refine() of what is rendered; where that is paused it waits. Edits forget regions.
  /// Throws Error(input), too, while nothing is rendered, or a view that moves: its pictures are
  /// replaced.
  void refine(const RegionRequest& request);
  /// Whether there is something that could be refined now.
  bool can_refine() const;

  EngineStatus status() const;
  /// The newest; null: there is none yet.
  std::shared_ptr<const Snapshot> snapshot() const;
  /// The newest, once there is one with a larger number than that, or when the time is over: then
  /// null.
  std::shared_ptr<const Snapshot> wait_for_snapshot(uint64_t after,
                                                    std::chrono::milliseconds timeout) const;
  /// Job::look_at_film() of what is shown; false also if that is nothing.
  bool look_at_film(const std::function<void(const Film&)>& look) const;
  /// Job::finished_snapshot() of what is shown.
  std::optional<Image> finished_snapshot(const Messages& messages = {}) const;
  /// The scene of what is shown; null: nothing is.
  std::shared_ptr<const Scene> scene() const;
  /// Until it neither builds nor renders, and no command waits. False when the time was over
  /// before.
  bool wait_until_done(std::chrono::milliseconds timeout) const;

 private:
  using Clock = std::chrono::steady_clock;
  /// What is wanted: commands write it, the engine's thread makes it so.
  struct Wanted {
    std::shared_ptr<const Description> description;
    uint64_t revision = 0, starts = 0;
    bool runs = false, is_paused = false, ends = false;
    bool is_moving = false;  ///< of what was taken: whether it is by EngineSettings::moving
  };
  /// One description that is rendered.
  struct Run {
    uint64_t revision = 0;
    std::shared_ptr<Gate> gate;
    bool is_moving = false;
    std::shared_ptr<Job> job;  ///< those who look at it keep it for so long
  };

  void work();
  /// Builds what is wanted and, if that went well, renders it in the place of the run before.
  void take(const Wanted& wanted);
  /// What the run has kept of light, for the next one.
  void take_light();
  std::unique_ptr<Run> prepared(const Wanted& wanted);
  void begin(std::unique_ptr<Run> run);
  void end_run();
  std::shared_ptr<const Job> shown_job() const;
  /// What is rendered at rest; null: nothing is.
  std::shared_ptr<Job> resting_job() const;
  bool has_work() const;
  /// When a view that moves may come to rest, if nothing is edited until then.
  Clock::time_point end_of_motion() const;
  /// When it does so in any case.
  Clock::time_point longest_motion() const;
  /// Whether a description that is taken now is rendered by EngineSettings::moving.
  bool moves() const;
  /// Whether what is rendered by it has had its time.
  bool rests() const;
  /// Whether it is the view of that revision as it moved, with samples: of the same at rest nothing
  /// is shown that has less.
  bool shows_motion(uint64_t revision) const;
  EngineState state() const;
  /// Until the run has shown something, or a tenth of a second, a second where it moves.
  void let_show(std::unique_lock<std::mutex>& lock);
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
  Wanted wanted_, taken_;
  EngineStatus status_;        ///< the state is the run's: neither building nor paused
  Clock::time_point touched_;  ///< when it was last edited, or a view that moves began
  bool is_building_ = false;
  bool is_busy_ = false;            ///< the thread is doing what was wanted
  const Run* shown_ = nullptr;      ///< whose pictures and progress count
  std::shared_ptr<Job> shown_job_;  ///< of the same
  std::shared_ptr<Gate> gate_;      ///< of the run
  std::shared_ptr<const Snapshot> snapshot_;
  Clock::time_point published_;

  // Of the thread:
  std::unique_ptr<Run> run_;
  std::shared_ptr<const Scene> last_scene_;  ///< of the run before, to share with
  std::array<JobLight, 2> light_;            ///< the last that runs have kept: at rest, moving
  std::thread thread_;
};

}  // namespace kaustik
