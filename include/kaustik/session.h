#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "kaustik/picture.h"
#include "kaustik/scene.h"

namespace kaustik::v0 {

namespace details {
class SessionState;
}

/// What a session is to do. Without passes, samples, a time or an error it does what the scene asks
/// for.
struct SessionSettings {
  std::string integrator = {};     ///< instead of the scene's; "": that
  std::string camera = {};         ///< by its id; "": the first
  uint32_t passes = 0;             ///< 0: as many as the other limits say
  uint32_t samples_per_pixel = 0;  ///< of all passes together; 0: the scene's
  uint32_t samples_per_pass = 0;   ///< of each pass; 0: as it suits the others
  double seconds = 0;              ///< it ends then; 0: no limit
  double error = 0;                ///< it ends when Picture::relative_error() is that; 0: never
  uint64_t seed = 0;               ///< of all random numbers
  uint32_t first_pass = 0;         ///< those before are somebody else's
  int threads = 0;                 ///< most that work at a time, building included; 0: all
  bool layers = true;              ///< pictures have layers, if the scene's film asks for them
  bool previews = false;           ///< snapshots show a coarse first look before there is more
  /// A file that finished passes are kept in while rendering, .kpt; "": none. A file of this name
  /// is replaced.
  std::string checkpoint = {};
  double checkpoint_interval_s = 30;
  /// Session::save() will be asked for: every file of the scene is read once more for its digest.
  bool keeps_passes = false;
};

enum class Stage {
  idle,      ///< not started, or ended
  building,  ///< the scene is built
  light,     ///< light is sent out
  picture    ///< pixels get samples
};

/// A look at a session.
struct Progress {
  Stage stage = Stage::idle;
  double fraction = 0;  ///< of the whole, 0 to 1
  double elapsed_s = 0;
  double remaining_s = -1;  ///< estimated; negative: not known
  uint32_t passes_done = 0;
  uint32_t passes_total = 0;       ///< 0: limited by time or error
  uint64_t samples_per_pixel = 0;  ///< of the passes that are done
  double rays_per_s = 0;
  double photons_per_s = 0;
  double relative_error = 0;  ///< infinite: not known yet
  bool has_picture = false;   ///< there is something for Session::snapshot()
};

enum class Severity {
  note,    ///< what the user may want to know
  warning  ///< what is odd, or went wrong by half
};

/// Functions of the host's. A session calls one of them at a time, from threads of its own. They
/// may ask for progress() and snapshot(), and stop(), pause() and resume() the session. What they
/// throw ends the session.
struct Callbacks {
  std::function<void(Severity, const std::string&)> message = {};
  std::function<void(const Progress&)> progress = {};  ///< a few times per second
  /// After each pass, with the number of those that are finished; no thread works meanwhile.
  std::function<void(uint32_t)> pass_done = {};
};

/// What ended a session.
enum class End { passes, time, error, stopped };

struct Outcome {
  End end = End::passes;
  uint32_t passes = 0;  ///< that are finished
  uint32_t samples_per_pass = 0;
  double seconds = 0;
  uint64_t rays = 0, photons = 0;
  double relative_error = 0;  ///< of the pixels; infinite: not known
  std::string integrator;     ///< that was used
};

/// Renders a scene. Sessions know nothing of each other: there may be many at once, and each has
/// the bits that it would have alone. Pictures have the same bits as those of `kaustik render`.
///
/// progress(), snapshot(), stop(), pause() and resume() may be called from any thread; all else by
/// one thread at a time, and not from callbacks: Error(misuse). The scene and the settings are
/// copied.
class KAUSTIK_EXPORT Session {
 public:
  /// Throws Error for settings that contradict themselves. The scene is built where it is started.
  explicit Session(const Scene& scene, const SessionSettings& settings = {},
                   Callbacks callbacks = {});
  /// Goes on with the passes in a file. The scene has to be what it was; integrator, camera, seed
  /// and samples per pass are those of the file, as is the end unless the settings say another.
  /// Throws Error for a file that is none, or of another version.
  static Session load(const std::string& path, const Scene& scene,
                      const SessionSettings& settings = {}, Callbacks callbacks = {});
  /// Stops, and waits. From a callback it only stops; what is left goes when the callback has
  /// returned.
  ~Session();
  Session(Session&&) noexcept;
  Session& operator=(Session&&) noexcept;

  /// Begins, in a thread of its own, and returns at once. A session is started once, and once more
  /// after each edit.
  void start();
  /// Until it has ended, by itself or stopped. Throws Error for what ended it otherwise; then
  /// picture() has the passes before.
  Outcome wait();
  /// start() and wait(), in this thread.
  Outcome run();
  /// Ends it soon; a scene that is being built is built. It keeps what is finished.
  void stop() noexcept;
  /// Threads rest until resume(); light that is on its way arrives.
  void pause() noexcept;
  void resume() noexcept;
  bool is_paused() const noexcept;
  /// start() was called, and it has not ended.
  bool is_running() const noexcept;

  Progress progress() const;
  /// The picture as it is now; none as long as there is nothing to see. With errors it takes the
  /// memory of the film once more. Throws Error if memory is short.
  std::optional<Picture> snapshot(bool with_errors = false) const;
  /// The picture after the end, with errors. Throws Error if the session runs, or nothing is
  /// finished.
  Picture picture() const;

  /// Stops, and takes another scene in the place of the one before. What is the same is not built
  /// again. It renders on if it was started. Throws Error if its passes are kept in a file; the
  /// scene itself is told of by wait().
  void edit(const Scene& scene);
  /// Writes the finished passes to a file, .kpt, for load(), `kaustik resume` and `kaustik merge`.
  /// Throws Error if the session runs, nothing is finished, or the settings did not say so.
  void save(const std::string& path) const;

 private:
  explicit Session(std::shared_ptr<details::SessionState> state);
  std::shared_ptr<details::SessionState> state_;
};

}  // namespace kaustik::v0
