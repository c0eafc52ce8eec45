#pragma once
#include <cstddef>
#include <cstdint>

namespace kaustik {

// What random numbers are drawn for. Every address of a Sampler is made of rows of these tables, so
// that no two uses share numbers: who needs numbers of his own adds a row, and the assertions below
// look for collisions. Sampler's constructor, which takes any scramble, is for these and for tests.

/// Whole paths and the like: see Sampler::at().
enum class Stream : uint32_t {
  camera,
  photon_global,
  photon_caustic,
  photon_place,
  light_path,
  cache,
  training,
  pixel_probe,
  photon_shadow,
  photon_volume,
  light_probe,
  disk_cover,
  aim_probe,
  direct_probe,
  pilot_light,
  pilot_path,
  training_pair,
  preview
};

/// More numbers beside those of a sampler: see Sampler::fork().
enum class Fork : uint32_t {
  light_group,
  light,
  light_probe,
  lens,
  caustic_sight,
  global_sight,
  caustic_cover,
  volume_sight,
  merge_cover,
  merge_bias,
  narrow_merge_cover,
  merge_part,
  merge_sight,
  medium_merge_sight,
  delta_branch,
  straight_branch,
  flight_looks,
  medium_looks
};

/// Branches of a path: see Sampler::split().
enum class Split : uint32_t {
  gather_ray,
  specular_ray,
  shadow_ray,
  light_sample,
  cache_record,
  hemisphere_ray,
  wave
};

/// Several samples of each index: see Sampler::one_of().
enum class Series : uint32_t { light_sample, connection };

/// Points of quadratures, which are the same in all renders: see Sampler::of().
enum class Quadrature : uint32_t {
  albedo,
  noise_class,
  light_texture,
  mesh_face,
  light_medium,
  aim_peak,
  aim_cone,
  aim_sphere,
  aim_or_own,
  aim_cell,
  aim_box
};

/// What quadratures are of. Those of one integrand have no points in common; others may, since
/// nothing is made of both.
enum class Integrand : uint32_t { bsdf, texture, light, medium, aim };

/// Whose forks, splits or series they are. Samplers of different parents have no numbers in common.
enum class Parent : uint32_t {
  vertex,        ///< of a path, or a segment: a sampler on its way
  chosen_light,  ///< the sampler once a light has been chosen
  light,         ///< Fork::light
  probe,         ///< Stream::light_probe
  cache,         ///< Stream::cache
  record,        ///< Split::cache_record
  waves          ///< a field of waves
};

/// A row: what tells this use from the others of its parent is a number of `count` from `first` on.
template <typename Use, typename Of>
struct DrawRow {
  Use use;
  /// The parent; of a quadrature the integrand; of a stream a number that few others share.
  Of of;
  uint64_t first, count;
  const char* what;
};
using StreamRow = DrawRow<Stream, uint32_t>;
using ForkRow = DrawRow<Fork, Parent>;
using SplitRow = DrawRow<Split, Parent>;
using SeriesRow = DrawRow<Series, Parent>;
using QuadratureRow = DrawRow<Quadrature, Integrand>;

inline constexpr uint64_t most_elements = uint64_t(1) << 40;

inline constexpr StreamRow stream_rows[] = {
    {Stream::camera, 0, 0, most_elements, "camera samples, by pixel"},
    {Stream::photon_global, 1, 0, most_elements, "global photons, by light"},
    {Stream::photon_caustic, 2, 0, most_elements, "caustic photons, by light"},
    {Stream::photon_place, 3, 0, most_elements, "paths that tell where photons are kept, by light"},
    {Stream::light_path, 4, 0, most_elements, "light paths that are splatted, merged, connected"},
    {Stream::cache, 5, 0, most_elements, "irradiance cache: records (0), paths by pixel (from 1)"},
    {Stream::training, 6, 0, most_elements, "photons that tell how many each light gets"},
    {Stream::pixel_probe, 6, most_elements, most_elements, "what pixels show, by block"},
    {Stream::photon_shadow, 7, 0, most_elements, "shadow photons, by light"},
    {Stream::photon_volume, 8, 0, most_elements, "volume photons, by light"},
    {Stream::light_probe, 9, 0, most_elements, "paths that tell which lights are seen"},
    {Stream::disk_cover, 10, 0, most_elements, "what covers disks of merging, by block"},
    {Stream::aim_probe, 11, 0, most_elements, "whether aimed emission goes anywhere, by light"},
    {Stream::direct_probe, 12, 0, most_elements, "direct light that light paths compete with"},
    {Stream::pilot_light, 13, 0, most_elements, "light paths before the first pass"},
    {Stream::pilot_path, 14, 0, most_elements, "camera paths before the first pass, by block"},
    {Stream::training_pair, 15, 0, most_elements, "pairs of samples to learn from, by block"},
    {Stream::preview, 16, 0, most_elements, "first looks, by square"},
};

inline constexpr uint64_t most_lights = 0x70000000;

inline constexpr ForkRow fork_rows[] = {
    {Fork::light_group, Parent::chosen_light, 0, 16, "a group of shadow rays of a sample"},
    {Fork::light, Parent::vertex, 0, most_lights, "a light, where each is sampled"},
    {Fork::light_probe, Parent::probe, 1, 1, "light at a point of such a path"},
    {Fork::lens, Parent::vertex, 0x70000009, 1, "the point of the lens that a light path seeks"},
    {Fork::caustic_sight, Parent::vertex, 0x70000001, 1, "which caustic photons are looked at"},
    {Fork::global_sight, Parent::vertex, 0x70000002, 1, "which global photons are looked at"},
    {Fork::caustic_cover, Parent::vertex, 0x70000003, 1, "what covers the disk of caustic photons"},
    {Fork::volume_sight, Parent::vertex, 0x70000007, 1, "which volume photons are looked at"},
    {Fork::merge_cover, Parent::vertex, 0x70000010, 1, "what covers the disk of merging"},
    {Fork::merge_bias, Parent::vertex, 0x70000011, 1, "whether the bias of merging is estimated"},
    {Fork::narrow_merge_cover, Parent::vertex, 0x70000012, 1, "what covers the narrow disk then"},
    {Fork::merge_part, Parent::vertex, 0x70000013, 1, "the part of the light vertices that merges"},
    {Fork::merge_sight, Parent::vertex, 0x70000014, 1, "which light vertices are looked at"},
    {Fork::medium_merge_sight, Parent::vertex, 0x70000015, 1, "the same in media"},
    {Fork::delta_branch, Parent::vertex, 0x70000016, 1, "a branch at a smooth transparent surface"},
    {Fork::straight_branch, Parent::vertex, 0x70000018, 1, "a branch that goes straight on"},
    {Fork::flight_looks, Parent::vertex, 0x70000017, 1, "where a flight looks at the density"},
    {Fork::medium_looks, Parent::vertex, 0x80000000, 0x80000000, "the same of segments, by hash"},
};

inline constexpr SplitRow split_rows[] = {
    {Split::gather_ray, Parent::vertex, 1, 1, "gather rays"},
    {Split::specular_ray, Parent::vertex, 2, 1, "specular rays, where there are several"},
    {Split::shadow_ray, Parent::chosen_light, 16, 16, "further shadow rays, by group"},
    {Split::light_sample, Parent::light, 0, 1, "samples of one light"},
    {Split::cache_record, Parent::cache, 0, uint64_t(1) << 32, "records of a cache, by round"},
    {Split::hemisphere_ray, Parent::record, 0x4e15, 1, "rays over the hemisphere of a record"},
    {Split::wave, Parent::waves, 0, 1, "waves of a field"},
};

inline constexpr SeriesRow series_rows[] = {
    {Series::light_sample, Parent::vertex, 0, 1, "samples of one light each"},
    {Series::connection, Parent::vertex, 1, 1, "light vertices to connect"},
};

inline constexpr uint64_t most_faces = uint64_t(1) << 32;

inline constexpr QuadratureRow quadrature_rows[] = {
    {Quadrature::albedo, Integrand::bsdf, 0, 1 << 16, "albedos, by node of a table"},
    {Quadrature::noise_class, Integrand::texture, 0x6e6f697365, 1, "how often noise has a value"},
    {Quadrature::light_texture, Integrand::light, 0x7061747465726e, 1, "a lamp's mean radiance"},
    {Quadrature::mesh_face, Integrand::light, 0, most_faces, "that of a triangle, by triangle"},
    {Quadrature::light_medium, Integrand::medium, 0, 1, "what is left of light from infinity"},
    {Quadrature::aim_peak, Integrand::aim, 0x61696d, 1, "the most that a lamp emits"},
    {Quadrature::aim_cone, Integrand::aim, 0x61696e, 1, "what it emits into a cone"},
    {Quadrature::aim_sphere, Integrand::aim, 0x61696f, 1, "what it sends to a sphere"},
    {Quadrature::aim_or_own, Integrand::aim, 0x616970, 1, "whether aiming it pays"},
    {Quadrature::aim_cell, Integrand::aim, 0x70726f6a, 1, "what it emits into a cell"},
    {Quadrature::aim_box, Integrand::aim, 0x706f696e74, 1, "how flux varies by the boxes aimed at"},
};

constexpr const StreamRow& row_of(Stream stream) { return stream_rows[size_t(stream)]; }
constexpr const ForkRow& row_of(Fork fork) { return fork_rows[size_t(fork)]; }
constexpr const SplitRow& row_of(Split split) { return split_rows[size_t(split)]; }
constexpr const SeriesRow& row_of(Series series) { return series_rows[size_t(series)]; }
constexpr const QuadratureRow& row_of(Quadrature use) { return quadrature_rows[size_t(use)]; }

/// Whether both rows may mean the same numbers.
template <typename Row>
constexpr bool collide(const Row& a, const Row& b) {
  return a.of == b.of && a.first < b.first + b.count && b.first < a.first + a.count;
}

/// Whether all rows stand where row_of() looks for them, `last` is the last, and none collide.
template <typename Row, size_t count, typename Use>
constexpr bool are_sound(const Row (&rows)[count], Use last) {
  if (size_t(last) + 1 != count) return false;
  for (size_t i = 0; i < count; ++i) {
    if (size_t(rows[i].use) != i || rows[i].count == 0) return false;
    for (size_t k = 0; k < i; ++k)
      if (collide(rows[i], rows[k])) return false;
  }
  return true;
}
static_assert(are_sound(stream_rows, Stream::preview));
static_assert(are_sound(fork_rows, Fork::medium_looks));
static_assert(are_sound(split_rows, Split::wave));
static_assert(are_sound(series_rows, Series::connection));
static_assert(are_sound(quadrature_rows, Quadrature::aim_box));

}  // namespace kaustik
