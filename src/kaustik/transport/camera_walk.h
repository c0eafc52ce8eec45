#pragma once
#include <optional>

#include "kaustik/base/sampler.h"
#include "kaustik/transport/direct_light.h"
#include "kaustik/transport/integrator.h"
#include "kaustik/transport/path_class.h"
#include "kaustik/transport/path_state.h"
#include "kaustik/transport/scatterer.h"
#include "kaustik/transport/travel.h"
#include "kaustik/transport/visibility.h"
#include "kaustik/transport/visibility_estimator.h"
#include "kaustik/transport/volume_light.h"

namespace kaustik {

class LightWeights;

/// What a model changes in direct light.
struct LightRules {
  bool shadows = true;                 ///< without, nothing holds light off
  bool classical_attenuation = false;  ///< see LightTraits::attenuation
  LightWeights* weights = nullptr;     ///< in place of path tracing's
  VisibilityEstimator* visibility =
      nullptr;  ///< where it knows whether light arrives, no ray is traced
};

/// How much light counts where it is found in one of several ways; see PathWeights.
class LightWeights {
 public:
  virtual ~LightWeights() = default;
  /// Of light sampled at `vertex`.
  virtual float sampled(const Scatterer& vertex, const DirectLight& light) = 0;
  /// Of light that the path meets, on the surface of `vertex` …
  virtual float met(int light, const SurfaceVertex& vertex) = 0;
  /// … or beyond the scene.
  virtual float met(int light, const Ray& ray) = 0;
};

/// A path that is followed from the camera, vertex by vertex. Knows the component of everything
/// that it finds and weighs light found by scattering against light found by sampling lights; the
/// integrators differ in what they do at a vertex and in where they go on.
class CameraWalk {
 public:
  /// `traced`: lobes whose events count as specular. Starts with the ray through `raster`. Where
  /// the film asks for irradiance, the first surface is painted white (SurfaceVertex::paint_white)
  /// and what it sends is counted π times; nothing before it counts. Where the camera has gauges,
  /// the walk begins at one, which is the first surface that it comes to.
  CameraWalk(const Scene& scene, const Vec2f& raster, Sampler& sampler, SampleSink& sink,
             Lobes traced = Lobes::specular);
  ~CameraWalk() { sink_.count_rays(rays_); }
  /// A branch: the same path so far, to go on with numbers of its own.
  CameraWalk(const CameraWalk& other, Sampler& sampler);
  CameraWalk(const CameraWalk&) = delete;
  CameraWalk& operator=(const CameraWalk&) = delete;

  /// Goes to the next surface and adds the light that shines from there or from beyond the scene.
  /// False if there is no surface. Media on the way take their share; what they scatter into the
  /// path is added where `volume` is given.
  /// Light that the walk meets counts by `weights`, where given, in place of path tracing's.
  bool advance(const VolumeLight* volume = nullptr, LightWeights* weights = nullptr);
  /// The same by free flight: the path may also come to a point in a medium, where the next event
  /// is add_medium_light() and scatter_in_medium() instead of what there is for surfaces.
  enum class Arrival { nothing, surface, medium };
  Arrival fly(const VolumeLight* volume = nullptr, LightWeights* weights = nullptr);
  /// From now on the walk stays, if told so, at surfaces that light passes straight in part, and
  /// does not choose: waits_at_straight().
  void wait_at_straight(bool waits) { waits_at_straight_ = waits; }
  /// With which chance others would go straight on where it has stayed for that, until it goes on;
  /// 0: it has not. Two branches are to be followed then: one that stays …
  float straight_chance() const { return straight_chance_; }
  void stay_at_surface();
  /// … and one that goes on behind the surface.
  void go_straight();
  /// On its next way the walk meets lamps alone: where there is none, as beyond what it finds, it
  /// ends (Arrival::nothing), and nothing more is looked at. Media take their share as ever.
  void meet_lamps_only() { meets_lamps_only_ = true; }
  const SurfaceVertex& vertex() const { return vertex_; }
  /// The surface, or the point of a medium, that the walk has come to: until it is scattered.
  Scatterer scatterer() const {
    if (!is_in_medium_) return vertex_;
    return {in_medium_.point.position, -ray_.direction, *state_.medium};
  }
  /// That the path arrived at the vertex through; null: vacuum.
  const Medium* medium() const { return state_.medium; }
  /// Number of the gauge that the walk is at; −1: it is at none.
  int gauge() const { return state_.depth == 0 ? gauge_ : -1; }
  /// Where it began.
  const Vec2f& raster() const { return raster_; }
  /// Numbers of the point of the lens where it began (see Camera).
  const LensNumbers& u_lens() const { return u_lens_; }
  /// Of the light that it asks for.
  const Wavelengths& wavelengths() const { return state_.wavelengths; }
  /// Of what the camera sees, relative to what the vertex sends back.
  const Spectrum& throughput() const { return state_.throughput; }
  /// Scattering events so far.
  int events() const { return state_.depth; }
  /// Whether the camera sees the vertex directly or by specular events alone.
  bool all_events_specular() const { return class_.all_specular(); }
  /// The same by delta events alone.
  bool all_events_delta() const { return !from_first_.has_events(); }
  /// The beam that the walk stands for; its width at the vertex begins as half a pixel's: many
  /// samples share a pixel, so that textures are filtered by half of it.
  const Footprint& footprint() const { return state_.footprint; }
  Sampler& sampler() { return sampler_; }

  /// Adds light sampled at the vertex and reflected by its lobes. The probabilities are those that
  /// scatter() will be told there (0: never, then light sampling alone has to find the light).
  void add_direct_light(float diffuse_probability, float glossy_probability,
                        const LightSampling& sampling = {}, const LightRules& rules = {});
  /// Adds radiance that the vertex sends back of light that is `component` (caustic or indirect)
  /// to it; seen by another event it counts as that event's.
  void add_photon_light(Component component, const Spectrum& radiance) {
    add(seen(component), radiance);
  }
  bool wants_photon_light(Component component) const { return wants(seen(component)); }

  /// Density per solid angle with which the last event was sampled; 0: delta, or none yet.
  float last_pdf() const { return state_.pdf_forward; }
  /// Along which the next advance() goes.
  const Ray& ray() const { return ray_; }
  /// From the lens to the vertex along the path, m; before the first advance() to the ray's origin.
  float distance() const { return distance_; }
  // Components count from the first vertex on, as if the camera itself saw it. What delta events
  // before it show goes to the sink as specular.

  /// The component of light that arrives at the vertex, after specular events only or others, and
  /// leaves it by `event`.
  Component component_of(Lobes event, bool after_specular_events) const {
    CameraPathClass path = from_first_;
    path.add_event(event);
    path.add_event(after_specular_events ? Lobes::glossy : Lobes::diffuse);
    return path.component();
  }
  /// Of the events before the vertex.
  const CameraPathClass& path_class() const { return class_; }
  /// Adds radiance that the vertex sends back.
  void add(Component component, const Spectrum& radiance) {
    if (wants(component)) sink_.add(shown_as(component), state_.throughput * radiance);
  }
  /// An estimate of the bias of what add() was given.
  void add_bias(const Spectrum& radiance) { sink_.add_bias(state_.throughput * radiance); }
  bool wants(Component component) const { return wanted_.has(component); }
  /// From now on the walk and its branches look for nothing of that component: somebody else has
  /// found all of it. At a first vertex that is for its other lobes: whoever goes on from there by
  /// a delta event looks for all light again.
  void leave_out(Component component) { wanted_ = wanted_.without(component); }
  /// From now on what is found is not shown as specular because of the delta events so far.
  void show_as_seen() { is_mirrored_ = false; }
  /// What layers show of the surface that is seen, by this walk and its branches.
  const FirstHit& first_hit() const { return sink_.first_hit(); }
  void set_first_hit(const FirstHit& seen) { sink_.set_first_hit(seen); }
  /// The walk changes it no more.
  void keep_first_hit() { only_delta_ = false; }
  uint64_t& rays() { return rays_; }
  Work work() { return {rays_, sink_.scratch()}; }

  /// Whether anything that is wanted may be found further on.
  bool may_find_more() const { return from_first_.may_find(wanted_); }

  /// Of light that a medium scatters into the path on its next segment.
  Component component_in_medium() const { return from_first_.component_in_medium(); }
  /// Adds light sampled at the point in the medium and scattered there.
  void add_medium_light(LightWeights* weights = nullptr);
  /// Chooses a direction by the medium's phase function for the next fly().
  void scatter_in_medium(const Vec2f& u);

  /// Chooses a direction by `lobes` for the next advance(); false if the light is absorbed.
  /// `probability` is that of having chosen these lobes, or the number of branches that do so.
  bool scatter(Lobes lobes, float probability, float u_lobe, const Vec2f& u);
  /// The two events between which chance chooses where a smooth transparent surface both reflects
  /// and transmits, and does nothing else; pdf_solid_angle is the chance.
  struct DeltaEvents {
    BsdfSample reflection, transmission;
  };
  std::optional<DeltaEvents> delta_events() const;
  /// The path goes on by one of these as the one of several branches that always does.
  void branch(const BsdfSample& event);
  /// Russian roulette on the throughput; false if the path ends.
  bool survive(float u);
  /// The same with a chance that does not come from the throughput.
  bool survive_with(float chance, float u) {
    if (!(u < chance)) return false;
    has_survived(chance);
    return true;
  }
  /// Such roulette, asked before, is over.
  void has_survived(float chance) {
    state_.throughput *= 1 / chance;
    state_.roulette_scale *= chance;
  }

 private:
  Component seen(Component component) const {
    return all_events_delta() ? component : from_first_.component_after(Lobes::diffuse);
  }
  Component shown_as(Component component) const {
    return is_mirrored_ ? Component::specular : component;
  }
  void add_event(Lobes event);
  void go_on(const BsdfSample& event, float probability);
  void add_reflected(Lobes event, const Spectrum& radiance) {
    add(from_first_.component_after(event), radiance);
  }
  float emission_weight(int light, const LightTarget& target) const;
  /// Whether the walk is still on its way to the surface whose irradiance is asked for.
  bool seeks_irradiance() const {
    return state_.depth == 0 && scene_.film().quantity == Quantity::irradiance;
  }
  /// The pixel's gauge, if there is one.
  Arrival arrive_at_gauge();
  void add_background(LightWeights* weights);
  void add_emission(LightWeights* weights);
  /// Whether the camera looks through a surface that the walk has come to.
  bool looks_through(const SurfaceVertex& vertex) const {
    return state_.depth == 0 && scene_.is_hidden(vertex.light());
  }
  void describe_what_is_seen(const SurfaceVertex& vertex, float distance);
  template <typename PassMedium>
  Arrival arrive(LightWeights* weights, const PassMedium& pass_medium);

  /// What becomes of the walk at a surface that it has come to.
  Passing passing(const SurfaceVertex& vertex);

  const Scene& scene_;
  Sampler& sampler_;
  SampleSink& sink_;
  ComponentSet wanted_;  ///< what the sink wants, but for what was left out
  PathState state_;
  CameraPathClass class_;
  CameraPathClass from_first_;  ///< of the events from the first on that is not delta
  bool is_mirrored_ = false;    ///< there are delta events before it
  LightChoice light_choice_ = LightChoice::one;  ///< of the last add_direct_light()
  Vec2f raster_;                                 ///< where it began
  LensNumbers u_lens_;                           ///< and of which point of the lens
  int gauge_ = -1;                               ///< that of the pixel; −1: it has none
  Ray ray_;
  SurfaceVertex vertex_;
  Receiver in_medium_;             ///< the point where fly() came to in a medium
  bool is_in_medium_ = false;      ///< the walk is there
  bool meets_lamps_only_ = false;  ///< meet_lamps_only()
  LightQuery previous_;            ///< of where the last event was
  float distance_ = 0;
  float straight_chance_ = 0;       ///< straight_chance()
  bool waits_at_straight_ = false;  ///< wait_at_straight()
  bool only_delta_ = true;  ///< every surface so far has delta lobes alone: first_hit() is open
  uint32_t segments_ = 0;   ///< traced so far: those across null boundaries count, each has a block
                            ///< of random numbers
  uint64_t rays_ = 0;
};

}  // namespace kaustik
