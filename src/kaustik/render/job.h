#pragma once
#include <chrono>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "kaustik/render/checkpoint_keeper.h"
#include "kaustik/render/finished_picture.h"
#include "kaustik/render/learning.h"
#include "kaustik/render/photon_tracing.h"
#include "kaustik/render/session.h"

namespace kaustik {

/// What a job tells its owner, from its own threads. What a function throws ends the job, and
/// wait() throws it. They must not start, edit, or wait for the job; snapshot(), cancel() and
/// abandon() they may call.
struct JobListener {
  Messages messages;
  std::function<void(const Progress&)> progress;  ///< Session::run()
  /// After every finished pass, when no thread works.
  std::function<void(const Film&)> pass_done;
  /// Last of all, when rendering has ended, cancelled or not: what wait() is going to throw, or
  /// null. Must not throw.
  std::function<void(const std::exception_ptr&)> ended = {};
};

/// What a job makes of its scene: a picture by run() or start(), lessons by learn(), photon maps by
/// trace_photons().
enum class JobTask : uint8_t { render, learn, trace_photons };

/// What an integrator has kept of light, and what of scene and integrator it belongs to.
struct JobLight {
  uint64_t key = 0;
  std::shared_ptr<const KeptLight> light;
};

/// What a job is to do.
struct JobSettings {
  JobTask task = JobTask::render;
  /// The program's version, the recipe, whose changes the job makes, its plan and outputs. What it
  /// lacks is filled in: samples per pass, passes, digest, view.
  RenderRecord record;
  /// Who asks for the recipe's integrator, for messages: "command line: --integrator".
  std::string integrator_origin = "integrator";
  /// Time counts from `clock_start` on. Of a team only the leader keeps a checkpoint, which must be
  /// given to all.
  SessionSettings session;
  BuildOptions build;
  std::string checkpoint;  ///< file that finished passes are kept in; "": none
  CheckpointOwner owner = CheckpointOwner::one;  ///< of that file
  /// Passes may be kept by Job::save(), too: all have their samples, and the scene its digest.
  bool keeps_passes = false;
  double every_s = 30;              ///< between two checkpoints
  std::optional<Checkpoint> begun;  ///< to go on with; throws if it is of another scene
  std::string begun_path;           ///< its file, for messages
  /// Lessons that hold for all passes, which then have its samples unless `session` says otherwise;
  /// throws if they are of another scene or integrator, and std::logic_error beside `begun`.
  std::optional<StoredLessons> learned;
  std::string learned_path;  ///< its file, for messages
  /// Snapshots show a preview_picture() until the integrator has something to show, where that
  /// begins with a light pass. It takes a fraction of a second of the render. Whatever is said
  /// here, they do so where time has ended the render before that.
  bool previews = false;
  /// Somebody will ask for Job::checkpoint(): the scene's digest is found out.
  bool keeps_digest = false;
  /// A scene to share with what is the same; null: none.
  std::shared_ptr<const Scene> previous;
  /// Whether the integrator keeps light for jobs whose camera is another: Integrator::keep_light().
  bool keeps_light = false;
  /// Of such a job: it is used if all but the camera is the same.
  JobLight light;
  std::chrono::steady_clock::time_point clock_start = std::chrono::steady_clock::now();
};

/// How a job ended.
struct JobResult {
  SessionReport report;
  RenderRecord record;  ///< complete, with the time it took
  /// Why the last checkpoint could not be written; null: it was, or none was wanted. Earlier ones
  /// are warnings.
  std::exception_ptr checkpoint_failure;
};

/// A render from a description to a film, in a thread of its own: scene, integrator, session and
/// checkpoint. Or, in the caller's thread, what else is made of a scene: JobTask. Prints nothing
/// and keeps nothing global, so that there may be many at once; each has the bits that it has
/// alone. Its functions are called by one owner; snapshot(), cancel() and abandon() from any
/// thread.
class Job {
 public:
  Job(Description description, JobSettings settings, JobListener listener = {});
  /// Cancels, and waits.
  ~Job();
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  /// Builds the scene and the integrator (photon maps need none) here and now; else start() does it
  /// in its thread. Throws Error.
  void prepare();
  /// Begins and returns at once. The description must not change from here on.
  void start();
  /// Until it has ended, by itself or cancelled. Throws what ended it otherwise: Error for what is
  /// wrong with the description, or what a callback has thrown. The film then holds the passes
  /// before. Throws std::logic_error if it was not started.
  const JobResult& wait();
  /// start() and wait() in this thread.
  const JobResult& run();
  /// Ends it soon, as SessionEnd::cancelled says; a scene that is being built is built.
  void cancel();
  /// cancel(), but what the running pass has is left out: sooner, for those who want no picture.
  void abandon();

  /// What `session.passes` passes (16 unless it says so) of the session's seed teach; complete, for
  /// a file. Throws as kaustik::learn() does, and std::logic_error if it is not the job's task.
  Learned learn(const ProgressFunction& progress = {});
  /// The photon maps of the session's seed, or a part of them; complete, for a file. The recipe
  /// says by which integrator "photonmap". Throws as trace_photon_maps() does, and std::logic_error
  /// if it is not the job's task.
  TracedPhotons trace_photons(const PhotonPart& part = {}, const ProgressFunction& progress = {});

  /// Session::snapshot(), or the preview; none before the scene is built, and after edit() until
  /// there is something to be seen of the new one. incomplete_key tells pictures that are not yet
  /// the integrator's, with a sample of each pixel. After the end there is one unless the job was
  /// cancelled.
  std::optional<Image> snapshot(bool with_layers = true) const;
  /// Whether there is something for refine() to ask. From any thread.
  bool has_session() const { return current_with_session() != nullptr; }
  /// Session::refine(). From any thread; throws Error(input), too, while there is no session.
  [[nodiscard]] bool refine(const RegionRequest& request);
  /// Session::regions(); none while there is no session. From any thread.
  std::vector<RegionProgress> regions() const;
  /// Session::look_at_film(); false also while there is no session.
  bool look_at_film(const std::function<void(const Film&)>& look) const;
  /// The session's snapshot as a file would show it: finished_picture() of it. None where there is
  /// not even a sample; a preview is none. From any thread, while the job runs.
  std::optional<Image> finished_snapshot(const Messages& messages = {}) const;
  /// Cancels, waits, and takes another description in the place of the one before: scene,
  /// integrator and film are made anew, with the recipe's changes; the scene shares with the one
  /// before what is the same. Lessons of the one before are left out. Goes on as before: renders if
  /// it was started. Throws std::logic_error if passes are kept in a checkpoint, where those of
  /// another scene do not belong; not what ended the render before.
  void edit(Description description);

  /// After prepare().
  const Scene& scene() const;
  /// To share with others, from any thread; null before prepare().
  std::shared_ptr<const Scene> shared_scene() const;
  /// After prepare(), from any thread: for a job that comes after this one.
  JobLight kept_light() const;
  /// Session::film_so_far(), from any thread, while the job runs.
  std::optional<Film> film_so_far() const;
  // Only while it does not run, after the session was made.
  const Film& film() const;
  /// Lives on after edits and the job; null: there was no session yet.
  std::shared_ptr<const Film> shared_film() const;
  Image image() const;  ///< Session::image()
  /// Writes the finished passes as a checkpoint. Throws as write_checkpoint() does, Error(input)
  /// if no pass is finished, and std::logic_error unless the job keeps passes.
  void save(const std::string& path) const;
  /// What image() shows, for finished_picture(). After wait().
  PictureFacts picture_facts() const;
  /// image() as it is to be written: finished_picture() of it. After wait().
  Image finished_image(const Messages& messages = {}) const;
  /// What a file of the finished passes would hold, to be kept in memory. After wait(). Throws
  /// Error(input) if no pass was finished, std::logic_error unless `keeps_digest` or a file of them
  /// was asked for.
  Checkpoint checkpoint() const;

 private:
  struct Run {
    PreparedScene prepared;
    std::unique_ptr<Session> session;
    std::shared_ptr<const Image> preview;         ///< null: none
    RenderRecord record;                          ///< once there is a session: that of its begin
    std::chrono::steady_clock::time_point begin;  ///< of the session
    double rested_s = 0;                          ///< how long the gate had been closed then
    uint64_t light_key = 0;                       ///< of what it keeps of light
  };
  std::shared_ptr<Run> current() const;
  std::shared_ptr<Run> current_with_session() const;  ///< null: there is no session
  /// How long the gate has been closed, s.
  double rested_s() const;
  std::shared_ptr<Run> prepared_run();
  void begin(JobTask task, const char* function);
  void work();
  void render();
  /// Hands the integrator what was learned before.
  void teach(const PreparedScene& prepared) const;
  bool keeps_passes() const {
    return settings_.keeps_passes || !settings_.checkpoint.empty() || settings_.session.team;
  }
  /// One of several processes that share the passes, and not the one whose film will hold all.
  bool is_follower() const {
    return settings_.session.team && !settings_.session.team->is_led_here();
  }
  void make_session(Run& run);
  bool begins_with_light(const Run& run) const;
  void make_preview(Run& run);

  Description description_;
  JobSettings settings_;
  JobListener listener_;
  std::shared_ptr<const Scene> previous_;  ///< before an edit, to share with
  mutable std::mutex mutex_;               ///< of what follows
  std::shared_ptr<Run> run_;               ///< null: not prepared
  std::stop_source stop_;
  bool is_abandoned_ = false;
  JobResult result_;  ///< of the thread while it runs
  std::exception_ptr failure_;
  bool is_started_ = false;
  std::thread thread_;
};

}  // namespace kaustik
