#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "kaustik/integrator/integrator.h"
#include "kaustik/render/film.h"

namespace kaustik {

/// How a session goes about its passes.
struct SessionSettings {
  uint64_t seed = 0;
  int threads = 0;  ///< 0: all
  uint32_t first_pass = 0;
  /// How many from the first on, those that the film begins with included; absent: see
  /// `samples_per_pixel` and `seconds`.
  std::optional<uint32_t> passes;
  /// Samples per pixel of all passes together, at least four where there are so many samples;
  /// absent: the scene's, else the integrator's default per pass.
  std::optional<uint32_t> samples_per_pixel;
  /// Of each pass, whatever is said above; then `samples_per_pixel` only says how many passes.
  std::optional<uint32_t> samples_per_pass;
  /// Stop before the pass that would end later than this; at least one pass is always finished, if
  /// one is left to do.
  std::optional<double> seconds;
  /// Stop when Film::picture_error() is at most this. It is looked at after 16, 32, 64, … passes
  /// only: who looks all the time, and stops when the error happens to look small, stops too early.
  std::optional<double> error;
};

/// A look at a running session.
struct Progress {
  enum class Stage { light, picture, done };
  Stage stage = Stage::light;
  double fraction = 0;  ///< of the whole, 0 to 1
  double elapsed_s = 0;
  double remaining_s = 0;     ///< estimated; negative: unknown
  uint32_t passes_done = 0;   ///< those that the film began with included
  uint32_t passes_total = 0;  ///< 0: limited by time or error
  double rays_per_s = 0;
  double photons_per_s = 0;   ///< stored or splatted, over the time of the light passes
  size_t memory_bytes = 0;    ///< resident, of the whole program
  double relative_error = 0;  ///< Film::picture_error(); infinite: not known yet
};

/// What came out of a session.
struct SessionReport {
  uint32_t passes = 0;  ///< that the film holds
  uint32_t samples_per_pass = 0;
  uint64_t rays = 0, photons = 0;
  uint64_t dropped_samples = 0;  ///< not finite, left out
  double seconds = 0;
  double light_seconds = 0;  ///< of it, in light passes
  double mean_error = 0;     ///< Film::mean_error()
  double picture_error = 0;  ///< Film::picture_error()
  bool cancelled = false;
  bool incomplete_pass = false;  ///< cancelled in the first pass: the picture is only part of it
  std::vector<std::string> warnings;
  std::vector<std::string> decisions;  ///< PassReport::decisions
};

/// Runs passes of an integrator over tiles of the picture on all threads, and sums them on the
/// film. Owns the loop, the clock, cancelling and progress, for every integrator. A film may begin
/// with passes of an earlier session; those are left out, and the result has the same bits as if
/// one session had rendered all.
class Session {
 public:
  /// The scene and the integrator must outlive the session. Throws Error for a picture too large.
  Session(const Scene& scene, const Integrator& integrator, const SessionSettings& settings);
  /// Goes on with `begun`, which must be of this scene's size and this integrator's components.
  Session(const Scene& scene, const Integrator& integrator, const SessionSettings& settings,
          Film begun);
  ~Session();

  /// Renders until a stop rule holds or `stop` is requested; then the film holds what is finished.
  /// `progress` is called from one thread at a time, a few times per second. `pass_done` is called
  /// after every finished pass, when no thread works: film() may be looked at then, and `stop`
  /// requested. What it takes counts as time of the session.
  SessionReport run(std::stop_token stop = {},
                    const std::function<void(const Progress&)>& progress = {},
                    const std::function<void()>& pass_done = {});

  const Film& film() const { return film_; }
  uint32_t samples_per_pass() const { return samples_per_pass_; }
  /// How many passes from the first on are planned; 0: limited by time or error.
  uint32_t planned_passes() const { return pass_count_; }

 private:
  class Monitor;
  void plan();
  PassRange planned() const;  ///< empty: limited by time or error
  /// Whether the error is small enough, where it is looked at.
  bool is_good_enough(double error) const;
  /// Whether pass `index`, the next one, is to be rendered.
  bool goes_on(uint32_t index, const std::stop_token& stop, const Monitor& monitor) const;
  /// False if it was cancelled midway.
  bool render_pass(uint32_t index, std::stop_token stop, Monitor& monitor);
  void render_tile(const Pass& pass, const PassState& state, int tile, const std::stop_token& stop,
                   Monitor& monitor);
  /// The mean over the pixel's samples, those before a stop request if there is one. Returns rays.
  uint64_t render_pixel(const Pass& pass, const PassState& state, int x, int y,
                        const std::stop_token& stop, Monitor& monitor);
  void add_splats();

  const Scene& scene_;
  const Integrator& integrator_;
  SessionSettings settings_;
  Film film_;
  SplatBuffer splats_;
  std::vector<PassPixel> pixels_;
  Vec2i tiles_;
  uint32_t pass_count_ = 0;  ///< 0: limited by time or error
  uint32_t samples_per_pass_ = 1;
  SessionReport report_;
};

/// Type of the integrator that make_integrator() makes: what the description asks for; else the
/// default, or photonmap where surfaces have models of their own, which others would ignore.
std::string integrator_type(const Description& description, const Scene& scene);

/// Makes the integrator that the description asks for, integrator_type() if it names none. What is
/// accepted without effect goes to `warnings`. Throws Error.
std::unique_ptr<Integrator> make_integrator(const Description& description, const Scene& scene,
                                            std::vector<std::string>& warnings);

}  // namespace kaustik
