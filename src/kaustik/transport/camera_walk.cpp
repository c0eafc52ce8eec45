#include "kaustik/transport/camera_walk.h"

#include "kaustik/transport/roulette.h"

namespace kaustik {
namespace {

/// Light sampled at `vertex` and reflected by `lobes`, weighted against sampling those lobes,
/// if there are no other weights.
Spectrum reflected(const SurfaceVertex& vertex, const DirectLight& light, Lobes lobes,
                   float lobe_probability, LightWeights* weights) {
  if (!any(vertex.lobes() & lobes)) return {};
  const Spectrum f = vertex.eval_cosine(light.wi, lobes);
  if (f.is_zero()) return {};
  if (weights) return f * light.radiance * weights->sampled(vertex, light);
  if (light.pdf_solid_angle == 0 || lobe_probability == 0) return f * light.radiance;
  return f * light.radiance *
         mis_weight(light.pdf_solid_angle, lobe_probability * vertex.pdf(light.wi, lobes));
}

/// Or a surface that light may pass, behind which there may be one.
bool may_be_lamp(const Scene& scene, uint32_t shape) {
  return scene.surface(shape).light >= 0 || scene.may_let_pass(shape);
}

/// What the classes of lobes of a vertex send back of direct light.
struct ReflectedLight {
  Spectrum by_diffuse, by_glossy;

  ReflectedLight& operator+=(const ReflectedLight& other) {
    by_diffuse += other.by_diffuse;
    by_glossy += other.by_glossy;
    return *this;
  }
  ReflectedLight& operator*=(float factor) {
    by_diffuse *= factor;
    by_glossy *= factor;
    return *this;
  }
};

}  // namespace

CameraWalk::CameraWalk(const Scene& scene, const Vec2f& raster, Sampler& sampler, SampleSink& sink,
                       Lobes traced)
    : scene_(scene),
      sampler_(sampler),
      sink_(sink),
      wanted_(sink.wanted()),
      class_(traced),
      from_first_(traced),
      raster_(raster),
      u_lens_(scene.camera().lens_numbers(sampler)) {
  const CameraTraits& camera = scene.camera().traits();
  const CameraRay first = scene.camera().sample_ray(raster, u_lens_);
  ray_ = first;
  distance_ = first.start;
  state_.footprint = Footprint::of_camera(camera.pixel_width + camera.pixel_spread * first.start,
                                          camera.pixel_spread);
  state_.medium = scene.camera_medium();
  state_.wavelengths = sink.wavelengths();
  if (!scene.gauges().empty()) gauge_ = scene.camera().gauge_at(raster);
  const float weight = seeks_irradiance() ? pi : camera.weight;
  if (weight != 1) {
    state_.throughput = Spectrum(weight);
    // Roulette is to find paths as likely as those of radiance.
    state_.roulette_scale = 1 / weight;
  }
}

CameraWalk::CameraWalk(const CameraWalk& other, Sampler& sampler)
    : scene_(other.scene_),
      sampler_(sampler),
      sink_(other.sink_),
      wanted_(other.wanted_),
      state_(other.state_),
      class_(other.class_),
      from_first_(other.from_first_),
      is_mirrored_(other.is_mirrored_),
      light_choice_(other.light_choice_),
      raster_(other.raster_),
      u_lens_(other.u_lens_),
      gauge_(other.gauge_),
      ray_(other.ray_),
      vertex_(other.vertex_),
      in_medium_(other.in_medium_),
      is_in_medium_(other.is_in_medium_),
      previous_(other.previous_),
      distance_(other.distance_),
      straight_chance_(other.straight_chance_),
      waits_at_straight_(other.waits_at_straight_),
      only_delta_(other.only_delta_),
      segments_(other.segments_) {}

void CameraWalk::describe_what_is_seen(const SurfaceVertex& vertex, float distance) {
  FirstHit seen;
  seen.albedo = vertex.albedo(Lobes::all);
  seen.normal = vertex.facing_normal();
  seen.depth = state_.depth == 0 ? distance : sink_.first_hit().depth;
  sink_.set_first_hit(seen);
}

CameraWalk::Arrival CameraWalk::arrive_at_gauge() {
  if (gauge_ < 0) return Arrival::nothing;
  sampler_.start_vertex(segments_++);
  const PlacedGauge& gauge = scene_.gauges()[size_t(gauge_)];
  state_.medium = gauge.medium;
  vertex_.stand_at(gauge.point, state_.wavelengths);
  describe_what_is_seen(vertex_, 0);
  return Arrival::surface;
}

/// Goes on until `pass_medium(length)`, asked about every segment through a medium, answers that
/// the path is scattered, or until a surface that is more than a boundary of media.
template <typename PassMedium>
CameraWalk::Arrival CameraWalk::arrive(LightWeights* weights, const PassMedium& pass_medium) {
  const bool only_arrives = seeks_irradiance();
  is_in_medium_ = false;
  if (state_.depth == 0 && !scene_.gauges().empty()) return arrive_at_gauge();
  if (ray_.t_max < 0) return Arrival::nothing;  // the camera sees nothing there
  const auto go_on = [&](const Hit& hit, bool found) {
    sampler_.start_vertex(segments_++);
    const float length = found ? hit.t : ray_.t_max;
    if (state_.medium && !only_arrives && pass_medium(length)) {
      if (found && only_delta_ && !meets_lamps_only_) {
        SurfaceVertex seen;
        seen.meet(scene_, ray_, hit, TransportMode::radiance, {}, state_.wavelengths);
        describe_what_is_seen(seen, distance_ + hit.t);
      }
      return false;
    }
    if (!found) {
      if (!only_arrives) add_background(weights);
      return false;
    }
    distance_ += hit.t;
    return !meets_lamps_only_ || may_be_lamp(scene_, hit.shape);
  };
  straight_chance_ = 0;
  if (!travel(scene_, state_, ray_, vertex_, rays_, sampler_, go_on,
              [this](const SurfaceVertex& vertex) { return passing(vertex); }))
    return is_in_medium_ && !meets_lamps_only_ ? Arrival::medium : Arrival::nothing;
  if (only_delta_) describe_what_is_seen(vertex_, distance_);
  if (only_arrives)
    vertex_.paint_white();
  else if (vertex_.light() >= 0)
    add_emission(weights);
  return meets_lamps_only_ ? Arrival::nothing : Arrival::surface;
}

Passing CameraWalk::passing(const SurfaceVertex& vertex) {
  if (looks_through(vertex)) return Passing::always;
  if (seeks_irradiance()) return Passing::never;
  if (!waits_at_straight_ || !vertex.passes_straight()) return Passing::by_chance;
  const float chance = passing_chance(vertex, vertex.straight());
  if (chance == 0 || chance == 1) return Passing::by_chance;
  straight_chance_ = chance;
  return Passing::never;
}

// Roulette must not see that this is one of several branches.
void CameraWalk::stay_at_surface() { state_.roulette_scale *= 1 / (1 - straight_chance_); }

void CameraWalk::go_straight() {
  state_.throughput *= vertex_.straight();
  state_.roulette_scale *= 1 / straight_chance_;
  pass_boundary(vertex_, state_, ray_);
}

bool CameraWalk::advance(const VolumeLight* volume, LightWeights* weights) {
  const Component in_medium = component_in_medium();
  if (!wants(in_medium)) volume = nullptr;
  return arrive(weights, [&](float length) {
           if (volume && state_.medium->scatters())
             add(in_medium, volume->radiance(ray_, length, *state_.medium, state_.wavelengths,
                                             sampler_, work()));
           state_.throughput *= state_.medium->transmittance({ray_.origin, ray_.direction, length},
                                                             state_.wavelengths, sampler_);
           return false;
         }) == Arrival::surface;
}

CameraWalk::Arrival CameraWalk::fly(const VolumeLight* volume, LightWeights* weights) {
  const Component in_medium = component_in_medium();
  if (!wants(in_medium)) volume = nullptr;
  return arrive(weights, [&](float length) {
    if (volume && state_.medium->scatters())
      add(in_medium,
          volume->radiance(ray_, length, *state_.medium, state_.wavelengths, sampler_, work()));
    const Medium::Flight flight = state_.medium->sample_flight(
        {ray_.origin, ray_.direction, length}, state_.throughput, state_.wavelengths, sampler_);
    state_.throughput *= flight.weight;
    if (!flight.scattered) return false;
    // As for light paths, which don't know the depth.
    in_medium_ = Receiver(ray_.origin + ray_.direction * flight.distance,
                          weights ? 1 : state_.depth, state_.wavelengths);
    is_in_medium_ = true;
    distance_ += flight.distance;
    state_.footprint.travel(flight.distance);
    return true;
  });
}

/// Weight of light found by the last event against sampling it from the previous vertex.
float CameraWalk::emission_weight(int light, const LightTarget& target) const {
  if (state_.pdf_forward == 0) return 1;
  return mis_weight(state_.pdf_forward,
                    direct_light_pdf(scene_, previous_, light_choice_, light, target));
}

void CameraWalk::add_emission(LightWeights* weights) {
  const Light& light = *scene_.lights()[size_t(vertex_.light())];
  const Spectrum emitted = light.emitted(vertex_.point(), vertex_.wo(), state_.wavelengths);
  if (emitted.is_zero()) return;
  const float weight = weights ? weights->met(vertex_.light(), vertex_)
                               : emission_weight(vertex_.light(), vertex_.point());
  add(from_first_.component(), emitted * weight);
}

void CameraWalk::add_background(LightWeights* weights) {
  for (const int index : scene_.environment_lights()) {
    const DistantLight& light = scene_.lights()[size_t(index)]->distant();
    if (light.traits().is_delta || (light.traits().is_only_seen && state_.pdf_forward > 0))
      continue;
    if (state_.depth == 0 && scene_.is_hidden(index)) continue;
    const float weight =
        weights ? weights->met(index, ray_) : emission_weight(index, ray_.direction);
    add(from_first_.component(), light.background(ray_.direction, state_.wavelengths) * weight);
  }
}

void CameraWalk::add_direct_light(float diffuse_probability, float glossy_probability,
                                  const LightSampling& sampling, const LightRules& rules) {
  light_choice_ = sampling.choice;
  if (!any(vertex_.lobes() & (Lobes::diffuse | Lobes::glossy))) return;
  // What nobody wants costs no shadow ray; its random numbers are drawn, so that the others stay.
  const auto wanted = [&](Lobes lobe) { return wants(from_first_.component_after(lobe)); };
  const auto reflect = [&](const DirectLight& light, ShadowAnswer& answer) {
    ReflectedLight result;
    if (wanted(Lobes::diffuse))
      result.by_diffuse =
          reflected(vertex_, light, Lobes::diffuse, diffuse_probability, rules.weights);
    if (wanted(Lobes::glossy))
      result.by_glossy =
          reflected(vertex_, light, Lobes::glossy, glossy_probability, rules.weights);
    if (result.by_diffuse.is_zero() && result.by_glossy.is_zero()) return result;
    Spectrum factor(1);
    if (rules.shadows)
      factor = arriving_share(scene_, light, rules.visibility,
                              vertex_.medium_toward(light.wi, state_.medium),
                              {state_.wavelengths, sampler_}, rays_, answer);
    if (rules.classical_attenuation)
      factor *=
          scene_.lights()[size_t(light.light)]->traits().attenuation.factor(vertex_.position());
    return ReflectedLight{result.by_diffuse * factor, result.by_glossy * factor};
  };
  // Light paths don't know how many events lie before the vertex, only that there are some.
  const int level = rules.weights ? std::min(state_.depth, 1) : state_.depth;
  const auto light = sample_direct_lights<ReflectedLight>(scene_, Receiver(vertex_, level),
                                                          sampling, sampler_, reflect);
  add_reflected(Lobes::diffuse, light.by_diffuse);
  add_reflected(Lobes::glossy, light.by_glossy);
}

void CameraWalk::add_medium_light(LightWeights* weights) {
  const Component component = component_in_medium();
  const Scatterer here = scatterer();
  const auto scatter = [&](const DirectLight& light, ShadowAnswer& answer) {
    if (!wants(component)) return Spectrum();
    const float phase = state_.medium->phase().eval(-ray_.direction, light.wi);
    float weight = 1;
    if (weights)
      weight = weights->sampled(here, light);
    else if (light.pdf_solid_angle > 0)
      weight = mis_weight(light.pdf_solid_angle, phase);
    const Spectrum visible = trace_shadow_ray(scene_, light, state_.medium,
                                              {state_.wavelengths, sampler_, true}, rays_, answer);
    return light.radiance * visible * (phase * weight);
  };
  light_choice_ = LightChoice::one;
  add(component,
      sample_direct_lights<Spectrum>(scene_, in_medium_, {light_choice_, 1}, sampler_, scatter));
}

void CameraWalk::scatter_in_medium(const Vec2f& u) {
  const PhaseFunction& phase = state_.medium->phase();
  const Vec3f wo = -ray_.direction, wi = phase.sample(wo, u);
  state_.pdf_forward = phase.eval(wo, wi);
  state_.footprint.scatter(Lobes::diffuse, state_.pdf_forward);
  state_.depth += 1;
  only_delta_ = false;
  class_.add_medium_event();
  from_first_.add_medium_event();
  previous_ = in_medium_.query();
  ray_ = {in_medium_.point.position, wi, infinity};
}

bool CameraWalk::scatter(Lobes lobes, float probability, float u_lobe, const Vec2f& u) {
  const BsdfSample sample = vertex_.sample(u_lobe, u, lobes);
  if (sample.event == Lobes::none || sample.weight.is_zero()) return false;
  go_on(sample, probability);
  return true;
}

std::optional<CameraWalk::DeltaEvents> CameraWalk::delta_events() const {
  constexpr float least = 0, most = 0.99999994f;
  if (vertex_.lobes() != Lobes::delta || !vertex_.transmits()) return std::nullopt;
  const DeltaEvents events{vertex_.sample(least, {0, 0}, Lobes::delta),
                           vertex_.sample(most, {0, 0}, Lobes::delta)};
  const auto is_some = [](const BsdfSample& sample) {
    return sample.event == Lobes::delta && !sample.weight.is_zero();
  };
  if (!is_some(events.reflection) || !is_some(events.transmission) ||
      events.reflection.transmission || !events.transmission.transmission)
    return std::nullopt;
  // A mask over glass has a third.
  constexpr float rounding = 1e-6f;
  if (events.reflection.pdf_solid_angle + events.transmission.pdf_solid_angle < 1 - rounding)
    return std::nullopt;
  return events;
}

void CameraWalk::branch(const BsdfSample& event) {
  state_.throughput *= event.pdf_solid_angle;
  state_.roulette_scale *= 1 / event.pdf_solid_angle;
  go_on(event, 1);
}

void CameraWalk::go_on(const BsdfSample& sample, float probability) {
  state_.throughput *= sample.weight * (1 / probability);
  // Roulette must not see that this is one of several branches.
  state_.roulette_scale *= sqr(sample.eta) * std::max(1.0f, probability);
  state_.pdf_forward = sample.event == Lobes::delta ? 0 : probability * sample.pdf_solid_angle;
  previous_ = light_query(vertex_, state_.depth);
  only_delta_ = only_delta_ && !any(vertex_.lobes() & (Lobes::diffuse | Lobes::glossy));
  add_event(sample.event);
  leave(vertex_, sample, sample.pdf_solid_angle, state_, ray_);
}

void CameraWalk::add_event(Lobes event) {
  class_.add_event(event);
  if (event != Lobes::delta || from_first_.has_events()) {
    from_first_.add_event(event);
    return;
  }
  // What was left out was that of the vertex's other lobes.
  is_mirrored_ = true;
  wanted_ = sink_.wants(Component::specular) ? ComponentSet::all() : ComponentSet();
}

bool CameraWalk::survive(float u) {
  // By the square root of the throughput: longer paths for less variance, by a tenth at equal time
  // in a room of bright walls.
  const float share = std::sqrt(state_.throughput.max_lane() * state_.roulette_scale);
  return survive_roulette(state_, share, u);
}

}  // namespace kaustik
