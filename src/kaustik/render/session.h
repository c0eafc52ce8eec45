#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "kaustik/render/film.h"
#include "kaustik/render/gate.h"
#include "kaustik/render/pass_division.h"
#include "kaustik/render/team.h"
#include "kaustik/transport/integrator.h"

namespace kaustik {

/// Passes of a region, beside those of the picture.
struct RegionRequest {
  PixelRegion pixels;
  uint32_t passes = 1;
};

/// What a region has, and what it is to have.
struct RegionProgress {
  PixelRegion pixels;
  uint32_t passes = 0;   ///< of its own, that are finished
  uint32_t waiting = 0;  ///< that were asked for
};

/// At most so many passes are asked for at a time.
inline constexpr uint32_t most_region_passes = 4096;
/// Where nobody says how far to go, each with the integrator's default samples.
inline constexpr uint32_t default_passes = 16;

/// How a session goes about its passes.
struct SessionSettings {
  uint64_t seed = 0;
  int threads = 0;  ///< 0: all
  uint32_t first_pass = 0;
  /// How many from the first on, those that the film begins with included; absent: see
  /// `samples_per_pixel` and `seconds`.
  std::optional<uint32_t> passes;
  /// Of the passes that are planned for the picture, from the first on, only this part. Limits of
  /// time and error then change nothing of what is planned.
  std::optional<PassPart> part;
  /// Passes go on until something else ends them, whatever the scene says of samples, with the
  /// integrator's default samples each. Then `passes` and `samples_per_pixel` have no meaning.
  bool is_endless = false;
  /// Samples per pixel of all passes together; absent: the scene's, else the integrator's default
  /// per pass. Unless `passes` says how many there are, there are at least four where there are so
  /// many samples, and no pass is long: many samples make many passes, not large ones.
  std::optional<uint32_t> samples_per_pixel;
  /// Of each pass, whatever is said above; then `samples_per_pixel` only says how many passes.
  std::optional<uint32_t> samples_per_pass;
  /// Stop then. A pass that is not finished until then counts as the part that it is, where each
  /// pixel has a sample: Session::image(). For so much of the first pass it is waited a twentieth
  /// of the time longer, at least half a second; else the film stays empty.
  std::optional<double> seconds;
  /// Others will go on with the passes, so one at least is finished whatever the time, and all have
  /// the samples that they would have without a limit of time.
  bool keeps_passes = false;
  /// Whether the film holds what images with layers do, if the scene's film asks for them.
  bool layers = true;
  /// Stop when Film::picture_error() is at most this. It is looked at after 16, 32, 64, … passes
  /// only: who looks all the time, and stops when the error happens to look small, stops too early.
  std::optional<double> error;
  /// Seconds since some moment, asked by several threads; absent: the machine's clock.
  std::function<double()> clock;
  /// Passes of regions: Session::refine(), from the begin.
  std::vector<RegionRequest> regions;
  /// The processes that share the passes; null: this one renders all. What ends a session then is
  /// the leader's to say, started passes are finished unless somebody cancels, regions get none of
  /// their own, and in the end the leader's film holds all, the others' nothing.
  std::shared_ptr<Team> team;
  /// Of a team, about: the leader's film has all passes so far every so many seconds, or from
  /// `soon_enough` of them on (team_pace.h), and `pass_done` is called then. Absent: at the end
  /// alone.
  std::optional<double> team_interval_s;
  /// While it is closed no samples are taken, and no time counts; a light pass is finished all the
  /// same. Null: nobody closes it.
  std::shared_ptr<Gate> gate;
};

/// A look at a running session.
struct Progress {
  enum class Stage { light, picture, done };
  Stage stage = Stage::light;
  double fraction = 0;  ///< of the whole, 0 to 1
  double elapsed_s = 0;
  double remaining_s = 0;          ///< estimated; negative: unknown
  uint32_t passes_done = 0;        ///< those that the film began with included
  uint32_t passes_total = 0;       ///< 0: limited by time or error
  uint64_t samples_per_pixel = 0;  ///< of the passes that are done
  double rays_per_s = 0;
  double photons_per_s = 0;   ///< stored or splatted, over the time of the light passes
  size_t memory_bytes = 0;    ///< resident, of the whole program
  double relative_error = 0;  ///< Film::picture_error(); infinite: not known yet
  bool has_picture = false;   ///< there is something for Session::snapshot()
};

/// What a snapshot shows.
struct SnapshotFacts {
  uint32_t passes = 0;             ///< that are finished; 0: samples of the first
  uint64_t samples_per_pixel = 0;  ///< on average
};

/// What ended a session: a goal of its settings, or a stop request before one was reached.
enum class SessionEnd { passes, time, error, cancelled };

/// What came out of a session.
struct SessionReport {
  uint32_t passes = 0;           ///< that the film holds
  uint32_t regional_passes = 0;  ///< of regions, beside
  uint32_t samples_per_pass = 0;
  uint64_t rays = 0, photons = 0;
  uint64_t dropped_samples = 0;  ///< not finite, left out
  double seconds = 0;
  double light_seconds = 0;  ///< of it, in light passes
  double mean_error = 0;     ///< Film::mean_error()
  double picture_error = 0;  ///< Film::picture_error()
  size_t film_bytes = 0;     ///< at the end
  /// Most that film, pass in progress and its splats took at a time.
  size_t rendering_bytes = 0;
  SessionEnd end = SessionEnd::passes;
  /// The film holds fewer samples than its one pass was to have: each pixel at least one.
  bool incomplete_pass = false;
  /// Share of a pass that was taken after those of the film: Session::image() has it, too.
  double part = 0;
  std::vector<std::string> warnings;
  std::vector<std::string> decisions;  ///< PassReport::decisions of the last pass

  bool cancelled() const { return end == SessionEnd::cancelled; }
};

/// Runs passes of an integrator over tiles of the picture on all threads, and sums them on the
/// film. Owns the loop, the clock, cancelling and progress, for every integrator. A film may begin
/// with passes of an earlier session; those are left out, and the result has the same bits as if
/// one session had rendered all.
///
/// Regions may be given passes of their own. Each is a pass like any other, but its samples are
/// taken in the region alone, and what it splats elsewhere is dropped. How many there are must not
/// depend on what samples have shown in these pixels: who asks for more just where single pixels
/// are bright makes them too dark on average. They teach an integrator nothing. Those that are
/// asked for together have the plans and the radii of the next pass of the picture, whose number is
/// kept with the film: so the same requests after the same passes have the same bits.
class Session {
 public:
  /// The scene and the integrator must outlive the session. Throws Error for a picture too large,
  /// and for more parts than passes.
  Session(const Scene& scene, const Integrator& integrator, const SessionSettings& settings);
  /// Goes on with `begun`, which must be of this scene's size and this integrator's components.
  Session(const Scene& scene, const Integrator& integrator, const SessionSettings& settings,
          Film begun);
  ~Session();

  /// Renders until a stop rule holds or `stop` is requested; then the film holds what is finished:
  /// whole passes, or fewer samples of the first pass where each pixel has at least one, or
  /// nothing; snapshot() may have something even then. What throws in it, callbacks included, ends
  /// it, and the film holds the passes before. `progress` is called from one thread at a time, a
  /// few times per second. `pass_done` is called after every finished pass, when no thread works:
  /// film() may be looked at then, and `stop` requested. What it takes counts as time of the
  /// session.
  SessionReport run(std::stop_token stop = {},
                    const std::function<void(const Progress&)>& progress = {},
                    const std::function<void()>& pass_done = {});

  /// From any thread, at any time: the region gets so many passes more, before the next pass of the
  /// picture, once that has one; unless time is over. False, and nothing is asked for, once run()
  /// has come to its end. Throws Error(input) if there are no such pixels, for regions that are too
  /// many or too large, or passes that are none or more than `most_region_passes`.
  [[nodiscard]] bool refine(const RegionRequest& request);
  /// From any thread: of all regions that have passes, or wait for some.
  std::vector<RegionProgress> regions() const;
  /// From any thread, before run() is stopped: it leaves out what the running pass has, even if
  /// that is the first one, and tells no error. Then it returns sooner.
  void abandon_pass() { is_pass_abandoned_ = true; }

  /// From any thread, at any time, in callbacks too: a whole picture of what there is. Of finished
  /// passes; in the first one of the samples so far, and pixels without any show those of a pixel
  /// near by: then incomplete_key says so. None: not even that is there. `facts` of it, if wanted.
  /// `with_layers`: Film::image().
  std::optional<Image> snapshot(SnapshotFacts* facts = nullptr, bool with_layers = true) const;
  /// Calls look(film) with the finished passes while none is added; false, and no call, if there is
  /// none. From any thread, at any time, but in callbacks of a look; rendering waits where it
  /// lasts.
  bool look_at_film(const std::function<void(const Film&)>& look) const;
  /// A copy of it; none before there is a finished pass. It takes as much memory once more.
  std::optional<Film> film_so_far() const;
  bool has_picture() const { return has_picture_; }
  /// Not while run() goes on: the film's image, with the part of a pass at its end.
  Image image(bool with_layers = true) const;

  const Film& film() const { return film_; }
  uint32_t samples_per_pass() const { return samples_per_pass_; }
  /// Of the session, or of its part.
  uint32_t first_pass() const { return settings_.first_pass; }
  /// How many passes from the first on are planned; 0: limited by time or error.
  uint32_t planned_passes() const { return pass_count_; }
  /// What the session's part is of; not divided if it has none.
  const PassDivision& division() const { return division_; }

 private:
  class Monitor;
  class TeamRun;
  struct CameraPass;
  struct Round;
  struct RegionWork;
  /// A pass, and where its samples are taken.
  struct Task {
    Pass pass;
    std::optional<PixelRegion> region = {};  ///< absent: all of the picture

    bool is_in(int x, int y) const { return !region || region->holds(x, y); }
    /// Of a tile, by its first pixel.
    bool meets_tile(const Vec2i& first) const {
      return !region || region->meets({first.x, first.y, PictureTiles::side, PictureTiles::side});
    }
  };
  /// Number `index` of the picture, or of a region, whose order the caller adds.
  Pass pass_of(uint32_t index) const;
  enum class PassEnd { complete, incomplete, discarded };
  void plan();
  void plan_picture();
  /// Leaves of the plan what is the part's.
  void take_part(const PassPart& part);
  /// Of a pass of a plan that does not say how many passes there are.
  uint32_t most_samples_per_pass() const;
  /// Of a plan that says nothing but how much time there is.
  uint32_t samples_by_time() const;
  /// The passes of a session without a team, and those of regions.
  SessionEnd run_alone(const std::stop_token& stop, Monitor& monitor,
                       const std::function<void()>& pass_done);
  /// One of several that share the passes, and not the one whose film will hold all.
  bool is_follower() const { return settings_.team && !settings_.team->is_led_here(); }
  PassRange planned() const;  ///< empty: limited by time or error
  /// Whether the error is small enough, where it is looked at.
  bool is_good_enough(double error) const;
  /// What ends the session before pass `index`, the next one; none: it is to be rendered.
  std::optional<SessionEnd> end_before(uint32_t index, const Monitor& monitor) const;
  /// Whether the next pass is to be rendered whole however late that is.
  bool must_be_finished(const Monitor& monitor) const;
  /// When the next pass is given up if it is no picture yet, in seconds of the session; absent:
  /// never.
  std::optional<double> last_second(const Monitor& monitor) const;
  PassEnd render_pass(const Task& task, std::stop_token stop, Monitor& monitor);
  /// Those of the regions that wait, until `stop` is requested or time is over.
  PassEnd render_regions(std::stop_token stop, Monitor& monitor,
                         const std::function<void()>& pass_done);
  /// Its plans are those of the next pass of the picture, and errors need one of it.
  bool can_render_regions() const { return film_.pass_count() > 0 && !report_.incomplete_pass; }
  /// The one whose turn it is; none waits otherwise.
  std::optional<PixelRegion> next_region() const;
  /// What is still to be done for regions, and what was done by this session.
  RegionWork waiting_work() const;
  void ask_for(const RegionRequest& request);
  void count_down(const PixelRegion& region);
  /// From here on no region is taken. False, and they are, if one waits that can be rendered.
  bool close_regions(SessionEnd end);
  /// Takes the pass's samples. False if it was halted: then pixels have fewer, maybe none.
  bool render_camera(const Task& task, const PassState& state, const std::stop_token& stop,
                     Monitor& monitor);
  /// The tile's samples of the round, until it is halted.
  void render_tile(CameraPass& camera, size_t tile, const Round& round);
  /// The same of a pixel, added to `sum`; returns rays.
  uint64_t render_pixel(CameraPass& camera, int x, int y, uint32_t end, Scratch& scratch,
                        PassPixel& sum) const;
  /// Means over the samples from their sums, and the splats.
  PassPixel finished(const PassPixel& pixel, int x, int y) const;
  /// The same of all pixels of a tile, whose splats are forgotten then.
  void finish(size_t tile, PassTiles::Pixels& pixels);
  /// Of all tiles of the task that are not finished yet.
  void finish_tiles(const Task& task);
  /// Gives the pass's memory back, so that what looks at the film may use it.
  void forget_pass(Monitor& monitor);
  /// Before a pass.
  void clear_pixels(const Pass& next, Monitor& monitor);
  /// Now, and `extra` bytes beside.
  void note_memory(size_t extra = 0);
  /// Share of the pass's samples that its pixels have.
  double share_taken(const Pass& pass, const PassState& state) const;
  Image first_samples(std::unique_lock<std::mutex> lock, SnapshotFacts& facts,
                      bool with_layers) const;

  const Scene& scene_;
  const Integrator& integrator_;
  SessionSettings settings_;
  Film film_;
  SplatBuffer splats_;
  Spectrum splat_balance_{1};         ///< WavelengthSets::balance() of the pass
  PassTiles pass_;                    ///< that is being rendered: sums, in finished tiles means
  std::vector<uint8_t> is_finished_;  ///< by tile
  uint32_t pass_count_ = 0;           ///< 0: limited by time or error
  uint32_t samples_per_pass_ = 1;
  PassDivision division_;
  SessionReport report_;
  uint32_t part_replicate_ = 0;  ///< of the pass that SessionReport::part is of

  mutable std::mutex regions_mutex_;
  std::vector<RegionProgress> regions_;  ///< in the order in which they were asked for
  bool takes_regions_ = true;

  // For snapshots.
  mutable std::mutex picture_mutex_;            ///< the film, and whether pixels are sums or means
  std::unique_ptr<std::mutex[]> tile_mutexes_;  ///< the pixels of a first pass
  std::atomic<bool> has_picture_;
  std::atomic<bool> is_pass_abandoned_{false};
};

/// Type of the integrator that make_integrator() makes: what the description asks for; else the
/// default, or photonmap where surfaces have models of their own, which others would ignore.
std::string integrator_type(const Description& description, const Scene& scene);

/// Makes the integrator that the description asks for, integrator_type() if it names none. What is
/// accepted without effect goes to `warnings`. Throws Error.
std::unique_ptr<Integrator> make_integrator(const Description& description, const Scene& scene,
                                            std::vector<std::string>& warnings);

}  // namespace kaustik
