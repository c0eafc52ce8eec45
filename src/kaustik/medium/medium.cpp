#include "kaustik/medium/medium.h"

#include <algorithm>
#include <cassert>

namespace kaustik {
namespace {

/// Probabilities of the lanes in proportion to `shares`; even where there are none.
Spectrum lane_probabilities(const Spectrum& shares) {
  const float sum = shares.sum();
  return sum > 0 && std::isfinite(sum) ? shares / sum : Spectrum(1.0f / Spectrum::lane_count);
}

int choose_lane(const Spectrum& probabilities, float u) {
  int last = 0;
  for (int lane = 0; lane < Spectrum::lane_count; ++lane) {
    if (!(probabilities[lane] > 0)) continue;
    last = lane;
    if (u < probabilities[lane]) return lane;
    u -= probabilities[lane];
  }
  return last;
}

/// Share of the light that collides within `distance`: 1 − exp(−σ d), exact for thin media.
float collision_chance(float extinction, float distance) {
  return extinction > 0 ? -std::expm1(-extinction * distance) : 0.0f;
}

}  // namespace

Medium::Medium(const Spectrum& extinction, const Spectrum& albedo,
               std::shared_ptr<const PhaseFunction> phase)
    : extinction_(extinction), scattering_(extinction * albedo), phase_(std::move(phase)) {
  assert(phase_);
}

bool Medium::is_like(const Medium& other) const {
  if (this == &other) return true;
  for (int lane = 0; lane < Spectrum::lane_count; ++lane)
    if (extinction_[lane] != other.extinction_[lane] ||
        scattering_[lane] != other.scattering_[lane])
      return false;
  return phase_->mean_cosine() == other.phase_->mean_cosine();
}

Spectrum Medium::transmittance(float distance) const {
  Spectrum result(1);
  // A lane that absorbs nothing stays 1 at an infinite distance too, where 0 · ∞ has no value.
  for (int lane = 0; lane < Spectrum::lane_count; ++lane)
    if (extinction_[lane] > 0) result.set(lane, std::exp(-extinction_[lane] * distance));
  return result;
}

Medium::Flight Medium::sample_flight(float limit, const Spectrum& shares, const Vec2f& u) const {
  const Spectrum probabilities = lane_probabilities(shares);
  const float chosen = extinction_[choose_lane(probabilities, u.x)];
  Flight flight;
  if (chosen > 0) flight.distance = -std::log1p(-u.y) / chosen;
  flight.scattered = flight.distance < limit;
  if (!flight.scattered) flight.distance = limit;
  const Spectrum left = transmittance(flight.distance);
  if (flight.scattered)
    flight.weight = scattering_ * left * (1 / (probabilities * extinction_ * left).sum());
  else
    flight.weight = left * (1 / (probabilities * left).sum());
  return flight;
}

Medium::Flight Medium::sample_collision(float limit, const Spectrum& shares, const Vec2f& u) const {
  Flight flight;
  const Spectrum scattered = shares * scattering_;
  if (!(scattered.sum() > 0) || !(limit > 0)) return flight;
  const Spectrum probabilities = lane_probabilities(scattered);
  const int lane = choose_lane(probabilities, u.x);
  const float chosen = extinction_[lane];
  flight.distance = std::min(-std::log1p(-u.y * collision_chance(chosen, limit)) / chosen, limit);
  flight.scattered = true;
  const Spectrum left = transmittance(flight.distance);
  float density = 0;
  for (int i = 0; i < Spectrum::lane_count; ++i)
    if (probabilities[i] > 0)
      density +=
          probabilities[i] * extinction_[i] * left[i] / collision_chance(extinction_[i], limit);
  flight.weight = scattering_ * left * (1 / density);
  return flight;
}

}  // namespace kaustik
