#pragma once
#include <cassert>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "kaustik/base/lane_sum.h"
#include "kaustik/base/progress.h"
#include "kaustik/base/sampler.h"
#include "kaustik/base/scratch.h"
#include "kaustik/base/wavelength_sets.h"
#include "kaustik/scene/scene.h"
#include "kaustik/transport/component.h"
#include "kaustik/transport/kept_light.h"
#include "kaustik/transport/shared_lessons.h"
#include "kaustik/transport/splat_buffer.h"

namespace kaustik {

/// Number of independent replicates; pass i belongs to replicate i mod 16.
inline constexpr uint32_t replicate_count = 16;

/// Passes of a region of the picture have numbers from here on, passes of all of it smaller ones:
/// so no random number is used twice. A multiple of `replicate_count`.
inline constexpr uint32_t first_regional_pass = uint32_t(1) << 31;

/// Passes of a region that were asked for together.
struct RegionOrder {
  uint32_t begin = 0;  ///< index of the first one
  /// The pass of all of the picture whose plans and radii they have.
  uint32_t stage = 0;
};

/// What makes a pass: its results are a function of this (and of the scene) alone.
struct Pass {
  uint64_t seed = 0;
  uint32_t index = 0;              ///< from 0
  uint32_t samples_per_pixel = 1;  ///< of this pass and every other
  /// Of all light of the pass: whatever meets in it is of the same set.
  WavelengthSets wavelengths = {};
  RegionOrder order = {};  ///< of a regional pass alone

  /// Of a pixel, on average, with each set of wavelengths.
  float samples_per_set() const { return float(samples_per_pixel) / float(wavelengths.count()); }
  bool is_regional() const { return index >= first_regional_pass; }
  /// The pass whose plans and radii this one has: itself, or that of its order. Random numbers of
  /// light paths go by the index, those of camera samples by sequence() and round().
  uint32_t stage() const { return is_regional() ? order.stage : index; }
  /// How many passes of its replicate come before it, in its order if it is regional: those whose
  /// camera samples are of the same sequence.
  uint32_t round() const { return (is_regional() ? index - order.begin : index) / replicate_count; }
  /// What tells the sequence of its camera samples from others of the seed: its replicate, or of a
  /// regional pass the first one of its order that is of that replicate.
  uint32_t sequence() const {
    return is_regional() ? order.begin + (index - order.begin) % replicate_count
                         : index % replicate_count;
  }
};

/// Camera samples of a pixel in a pass: how many, and which of its replicate's sequence. No index
/// may come twice in a replicate.
struct PixelSamples {
  uint32_t first_index = 0;
  uint32_t count = 1;
};

/// The share of an estimated bias that is right where light is smooth: SampleSink::add_bias().
inline constexpr float smooth_bias_share = 2.0f / 3;

/// What is known of the surface that a pixel shows, for denoisers and compositing.
struct FirstHit {
  // Of the first surface that is more than a mirror or clear glass; of the last of those if none is
  // behind them. Where rays branch, of the branch that was followed last.
  Spectrum albedo;
  Vec3f normal{0, 0, 0};  ///< unit (of a pixel: the mean), facing the viewer
  float depth = 0;        ///< distance of the first surface of all, m; 0: nothing hit
  /// Of a pixel: the share of its samples that see a lamp or a lit background, Component::emission;
  /// the film's edge finds out.
  float lamps = 0;
};

/// Where one camera sample's results go.
class SampleSink {
 public:
  /// For light of set number `set` of a pass's `wavelengths`. `scratch`, which must outlive this:
  /// for all that finds it. Who takes many samples has one for all of them; null: one of this
  /// sample.
  explicit SampleSink(ComponentSet wanted, const WavelengthSets& wavelengths = {},
                      Scratch* scratch = nullptr, size_t set = 0)
      : wanted_(wanted),
        wavelengths_(wavelengths[set]),
        set_(set),
        balance_(wavelengths.balance()),
        scratch_(scratch) {}
  void add(Component component, const Spectrum& radiance) {
    if (wanted_.has(component)) radiance_[size_t(component)] += radiance;
  }
  /// An estimate of the bias (expectation minus truth) of what the sample has added, of wanted
  /// components; may be as noisy as that and of either sign. Right where the bias grows by the
  /// width of what is averaged over, as at edges of light. Where light is smooth it grows by the
  /// area, and of pixels with neighbours it is smooth_bias_share of the estimate. Only if
  /// IntegratorTraits::estimates_bias.
  void add_bias(const Spectrum& bias) { bias_ += bias; }
  void set_first_hit(const FirstHit& hit) { first_hit_ = hit; }
  void count_rays(uint64_t rays) { rays_ += rays; }

  const Wavelengths& wavelengths() const { return wavelengths_; }
  size_t set() const { return set_; }
  /// Linear Rec. 709 of light in the sink's lanes, as the film is to have it.
  Spectrum rgb(const Spectrum& lanes) const {
    return rgb_from_lanes(lanes, wavelengths_) * balance_;
  }
  const Spectrum& radiance(Component component) const { return radiance_[size_t(component)]; }
  /// All components that are finite, as lane_sum() adds up their lanes.
  double all_light() const {
    double sum = 0;
    for (const Spectrum& radiance : radiance_)
      if (radiance.is_finite()) sum += double(lane_sum(radiance, wavelengths_));
    return sum;
  }
  const Spectrum& bias() const { return bias_; }
  const FirstHit& first_hit() const { return first_hit_; }
  uint64_t rays() const { return rays_; }
  bool wants(Component component) const { return wanted_.has(component); }
  ComponentSet wanted() const { return wanted_; }
  Scratch& scratch() { return scratch_ ? *scratch_ : own_scratch_; }

 private:
  ComponentSet wanted_;
  Wavelengths wavelengths_;
  size_t set_;
  Spectrum balance_;
  std::array<Spectrum, component_count> radiance_{};
  Spectrum bias_;
  FirstHit first_hit_;
  uint64_t rays_ = 0;
  Scratch* scratch_;
  Scratch own_scratch_;
};

/// Counters of a light pass, for progress and for the report.
struct PassReport {
  uint64_t rays = 0;
  uint64_t photons = 0;                ///< stored or splatted
  std::vector<std::string> warnings;   ///< a map that stayed empty, and why
  std::vector<std::string> decisions;  ///< what the integrator has chosen by itself, and why
};

/// The immutable state of one pass (photon maps, caches).
class PassState {
 public:
  virtual ~PassState() = default;
  PassReport report;
};

/// The state of a pass as the integrator has made it that is asked for a sample.
template <typename State>
const State& state_as(const PassState& state) {
  assert(dynamic_cast<const State*>(&state) && "the state is of another integrator");
  return static_cast<const State&>(state);
}

/// What is the same for an integrator in every pass.
struct IntegratorTraits {
  bool splats = false;          ///< prepare() splats, so that the session provides the buffer
  bool samples_camera = true;   ///< sample() does something
  bool estimates_bias = false;  ///< sample() estimates its bias: SampleSink::add_bias()
  ComponentSet components = ComponentSet::all();  ///< that its results hold
  /// Most sets of wavelengths that a pass may have in spectral mode.
  size_t most_wavelength_sets = WavelengthSets::most;
  /// Samples per pixel and pass if the user asks for nothing else.
  uint32_t default_samples_per_pass = 4;
};

/// What passes of one seed have taught an integrator.
struct Lessons {
  uint32_t passes = 0;         ///< the first so many
  std::vector<uint8_t> bytes;  ///< of the integrator's own making; none: it learns nothing
  bool empty() const { return bytes.empty(); }
  friend bool operator==(const Lessons&, const Lessons&) = default;
};

/// What becomes of lessons that are handed to an integrator.
enum class LessonUse {
  go_on,  ///< passes go on from them, as if the integrator had learned them itself
  fixed   ///< they hold for all passes, which teach nothing more
};

/// A method of computing the picture. Const and thread-safe; owns no film, no clock, and no loop
/// over the passes of a picture. (It may trace passes that only teach it.)
class Integrator {
 public:
  virtual ~Integrator() = default;
  const IntegratorTraits& traits() const { return traits_; }
  /// The light pass: what the samples of this pass need; may add to `splats`. Runs in parallel
  /// inside; returns early (state unusable) once `stop` is requested.
  virtual std::unique_ptr<PassState> prepare(const Pass& pass, SplatBuffer& splats,
                                             std::stop_token stop,
                                             const ProgressFunction& progress) const = 0;
  /// The visualisation pass for one point of the raster.
  virtual void sample(const PassState& state, const Vec2f& raster, Sampler& sampler,
                      SampleSink& sink) const = 0;
  /// Camera samples of a pixel in the pass of that state; their mean over the pixels is at most
  /// the pass's. All passes count alike.
  virtual PixelSamples pixel_samples(const PassState&, const Pass& pass,
                                     const Vec2i& /*pixel*/) const {
    return {pass.round() * pass.samples_per_pixel, pass.samples_per_pixel};
  }
  /// What the passes prepared so far have taught, for integrators of the same scene and parameters
  /// that go on from there; empty: nothing is learned. Not during prepare() and learn().
  virtual Lessons lessons() const { return {}; }
  /// Goes on with lessons() of another one. Throws Error(input) if they are damaged or of another
  /// picture. Before the first prepare() and learn().
  virtual void go_on_with(const Lessons& /*lessons*/, LessonUse) {}
  /// From now on prepared passes teach nothing by themselves, but what they teach can be taken
  /// here, as long as the integrator lives. Null: nothing is learned from passes. Before the first
  /// prepare() and learn(), after go_on_with().
  virtual SharedLessons* share_lessons() const { return nullptr; }
  /// Keeps from now on the light of pass 0 for kept_light(), and begins with `light`, null: none,
  /// which an integrator of the same parameters has kept in a scene that differs by its camera and
  /// film alone. Light of another seed or other wavelengths is not used. Pictures have the same
  /// bits. Before the first prepare(). Integrators whose light passes depend on the camera keep
  /// nothing.
  virtual void keep_light(const std::shared_ptr<const KeptLight>& /*light*/) {}
  /// Null: none, or none yet. At any time.
  virtual std::shared_ptr<const KeptLight> kept_light() const { return nullptr; }
  /// Learns from all passes before `pass` what that would be prepared with; fewer if `stop` is
  /// requested. An integrator that learns nothing does nothing.
  virtual PassReport learn(const Pass& /*pass*/, std::stop_token, const ProgressFunction&) const {
    return {};
  }

 protected:
  IntegratorTraits traits_;  ///< complete once the constructor is done
};

}  // namespace kaustik
