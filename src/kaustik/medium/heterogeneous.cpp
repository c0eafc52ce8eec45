#include "kaustik/medium/heterogeneous.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "kaustik/medium/coefficients.h"
#include "kaustik/medium/grid_tracking.h"
#include "kaustik/medium/medium_kinds.h"

namespace kaustik {
namespace {

/// The depth, m, behind which floats have no light left in any lane.
float darkest_depth(const Spectrum& extinction) {
  constexpr float no_light = 104;  // exp(−104) is less than the smallest float
  float depth = 0;
  for (int lane = 0; lane < Spectrum::lane_count; ++lane)
    depth = std::max(depth, extinction[lane] > 0 ? no_light / extinction[lane] : infinity);
  return depth;
}

const TypeInfo& heterogeneous_info() {
  static const TypeInfo info{
      "medium",
      "heterogeneous",
      "Smoke, clouds: absorbs and scatters light by a density that varies in space and ends at the "
      "box of its grid. A nested phase function gives the directions.",
      {albedo_parameter(), sigma_t_parameter(), medium_scale_parameter(),
       ignored_parameter("sample_emitters", ParameterKind::boolean),
       ignored_parameter("has_spectral_extinction", ParameterKind::boolean),
       ignored_parameter("method", ParameterKind::text),
       ignored_parameter("step_size", ParameterKind::number)}};
  return info;
}

/// Extinction as a grid: its density, and what there is where that is largest.
struct Extinction {
  std::shared_ptr<const GridVolume> density;  ///< null: everywhere the same
  SpectralValue largest;
};

void check_density_grid(const GridVolume& grid, const Place& place) {
  if (grid.least() < 0)
    throw Error(ErrorKind::input, fmt::format("a density of the grid is {:g}", grid.least()),
                "give densities from zero on", place);
  constexpr float least = 1e-30f;
  if (grid.largest() > 0 && grid.largest() < least)
    throw Error(ErrorKind::input,
                fmt::format("the largest density of the grid is {:g}", grid.largest()),
                "multiply the densities, and divide 'scale' by the same number", place);
}

Extinction extinction_of(const MediumInputs& inputs) {
  const auto scale = float(inputs.arguments.number("scale"));
  const GridVolume* grid = given_grid(inputs, "sigma_t");
  if (!grid) return {nullptr, coefficient(inputs, "sigma_t") * scale};
  const MediumInputs::GivenVolume& given = *inputs.volume("sigma_t");
  check_density_grid(*grid, given.place);
  const float largest = grid->largest() * scale;
  // The grid lives as long as the volume that it is a part of.
  if (grid->channels() == 1)
    return {std::shared_ptr<const GridVolume>(given.volume, grid), SpectralValue(largest)};
  if (largest == 0) return {};
  if (auto parts = grid->separated()) {
    const Vec3f& color = parts->color;
    return {std::make_shared<const GridVolume>(std::move(parts->density)),
            coefficient(Rgb{double(color.x), double(color.y), double(color.z)}) * largest};
  }
  throw Error(
      ErrorKind::input,
      grid->channels() == 3
          ? std::string("the colour of the grid of sigma_t differs from place to place")
          : fmt::format("the grid of sigma_t has {} channels", grid->channels()),
      "extinction has to be a density times one colour: give a grid of one channel; its colour can "
      "vary by the albedo alone",
      given.place);
}

/// Numbers of its own for each segment of a path.
Sampler numbers_of(const MediumSegment& segment, const Sampler& sampler) {
  const auto two = [](float a, float b) {
    return uint64_t(std::bit_cast<uint32_t>(a)) << 32 | std::bit_cast<uint32_t>(b);
  };
  const Vec3f& origin = segment.origin;
  const Vec3f& direction = segment.direction;
  uint64_t bits = hash_mix(two(origin.x, origin.y), two(origin.z, direction.x));
  bits = hash_mix(bits, two(direction.y, direction.z));
  return sampler.fork(Fork::medium_looks, uint32_t(bits >> 33));
}

}  // namespace

std::shared_ptr<const Medium> make_heterogeneous(const MediumInputs& inputs) {
  Extinction extinction = extinction_of(inputs);
  check_extinction(extinction.largest.rgb(), inputs.arguments);
  std::shared_ptr<const Volume> albedo;
  SpectralValue scattering;
  if (const GridVolume* grid = given_grid(inputs, "albedo")) {
    check_albedo_grid(*grid, inputs.volume("albedo")->place);
    if (grid->largest() > 0) {
      albedo = inputs.volume("albedo")->volume;
      scattering = extinction.largest;
    }
  } else {
    scattering = extinction.largest * coefficient(inputs, "albedo");
  }
  if (extinction.largest.rgb().is_zero()) return nullptr;
  return std::make_shared<HeterogeneousMedium>(
      HomogeneousMedium(extinction.largest, scattering, inputs.phase),
      std::move(extinction.density), std::move(albedo));
}

HeterogeneousMedium::HeterogeneousMedium(HomogeneousMedium densest,
                                         std::shared_ptr<const GridVolume> density,
                                         std::shared_ptr<const Volume> albedo)
    : Medium(densest),
      densest_(std::move(densest)),
      density_(std::move(density)),
      albedo_(std::move(albedo)) {
  float typical = 1;
  if (density_) {
    per_largest_ = 1 / density_->largest();
    typical = std::max(least_share, density_->mean(0) * per_largest_);
  }
  typical_extinction_ = densest_.typical_extinction() * typical;
}

bool HeterogeneousMedium::is_like(const Medium& other) const {
  if (this == &other) return true;
  const auto* o = dynamic_cast<const HeterogeneousMedium*>(&other);
  return o && density_ == o->density_ && albedo_ == o->albedo_ && densest_.is_like(o->densest_);
}

float HeterogeneousMedium::depth(const MediumSegment& segment, float from, float enough) const {
  if (!density_) return std::max(0.0f, segment.length - from);
  return per_largest_ * density_->integral(segment.origin, segment.direction, from, segment.length,
                                           enough / per_largest_);
}

GridCrossing HeterogeneousMedium::crossing(const MediumSegment& segment) const {
  return {*density_, segment.origin, segment.direction, segment.length};
}

Spectrum HeterogeneousMedium::extinction_of_value(const Wavelengths& wavelengths) const {
  return densest_.extinction({}, wavelengths) * per_largest_;
}

GridVolume::Reach HeterogeneousMedium::reach(const MediumSegment& segment, float flown) const {
  if (!density_) return {flown < segment.length, flown, segment.length};
  GridVolume::Reach result =
      density_->reach(segment.origin, segment.direction, segment.length, flown / per_largest_);
  result.integral *= per_largest_;
  return result;
}

Spectrum HeterogeneousMedium::transmittance(const MediumSegment& segment,
                                            const Wavelengths& wavelengths, const Sampler&) const {
  const float enough = darkest_depth(densest_.extinction({}, wavelengths));
  return densest_.transmittance(depth(segment, 0, enough), wavelengths);
}

Spectrum HeterogeneousMedium::rough_transmittance(const MediumSegment& segment,
                                                  const Wavelengths& wavelengths,
                                                  const Sampler& sampler) const {
  if (!density_) return densest_.transmittance(segment, wavelengths, sampler);
  return tracked_transmittance(crossing(segment), extinction_of_value(wavelengths),
                               numbers_of(segment, sampler));
}

void HeterogeneousMedium::measure(const MediumSegment& segment,
                                  std::vector<LineKnot>& knots) const {
  if (density_) density_->measure(segment.origin, segment.direction, segment.length, knots);
}

Spectrum HeterogeneousMedium::measured_transmittance(const MediumSegment& segment,
                                                     const std::vector<LineKnot>& knots,
                                                     const Wavelengths& wavelengths,
                                                     const Sampler& sampler) const {
  if (!density_) return transmittance(segment, wavelengths, sampler);
  const auto after = std::upper_bound(
      knots.begin(), knots.end(), segment.length,
      [](float distance, const LineKnot& knot) { return distance < knot.distance; });
  if (after == knots.begin()) return Spectrum(1);
  const LineKnot& last = *(after - 1);
  float all = last.integral * per_largest_;
  if (after != knots.end()) all += depth(segment, last.distance);
  return densest_.transmittance(all, wavelengths);
}

Medium::Flight HeterogeneousMedium::scattered_at(const MediumSegment& segment, float distance,
                                                 const Spectrum& weight,
                                                 const Wavelengths& wavelengths) const {
  Flight flight;
  flight.distance = std::min(distance, segment.length);
  flight.scattered = true;
  flight.weight = weight;
  if (albedo_)
    flight.weight *=
        albedo_->factor(segment.origin + segment.direction * flight.distance, wavelengths);
  return flight;
}

Medium::Flight HeterogeneousMedium::sample_flight(const MediumSegment& segment,
                                                  const Spectrum& shares,
                                                  const Wavelengths& wavelengths,
                                                  Sampler& sampler) const {
  const Sampler looks = sampler.fork(Fork::flight_looks);
  const Vec2f u = sampler.next_2d();
  if (!density_) {
    Flight flight = densest_.sample_flight(segment.length, shares, wavelengths, u);
    return flight.scattered ? scattered_at(segment, flight.distance, flight.weight, wavelengths)
                            : flight;
  }
  const TrackedFlight tracked =
      tracked_flight(crossing(segment), extinction_of_value(wavelengths),
                     HomogeneousMedium::flying_lane(shares, u.x), -std::log1p(-u.y), looks);
  if (tracked.collided)
    return scattered_at(segment, tracked.distance,
                        densest_.collided(tracked.left, shares, wavelengths), wavelengths);
  Flight flight;
  flight.distance = segment.length;
  flight.weight = HomogeneousMedium::passed(tracked.left, shares);
  return flight;
}

Medium::Flight HeterogeneousMedium::sample_collision(const MediumSegment& segment,
                                                     const Spectrum& shares,
                                                     const Wavelengths& wavelengths,
                                                     Sampler& sampler) const {
  const Vec2f u = sampler.next_2d();
  const float whole = depth(segment);
  const Flight in_depth = densest_.sample_collision(whole, shares, wavelengths, u);
  if (!in_depth.scattered) return {};
  // Sums may be rounded otherwise than the whole was.
  const GridVolume::Reach reached = reach(segment, std::min(in_depth.distance, 0.999999f * whole));
  if (!reached.is_reached) return {};
  return scattered_at(segment, reached.distance, in_depth.weight, wavelengths);
}

MediumType heterogeneous_type() { return {heterogeneous_info(), make_heterogeneous}; }

}  // namespace kaustik
