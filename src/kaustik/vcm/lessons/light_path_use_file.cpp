// What was learned of the use of light paths, and what a pass adds to it, as bytes.
#include <algorithm>
#include <cmath>

#include "kaustik/vcm/lessons/light_path_use.h"

namespace kaustik {
namespace {

/// Vertices of a path that its arrivals may be at, and of all paths that are remembered, on
/// average: far more than there are.
constexpr uint32_t most_vertices_before = 0xffff, most_vertices_of_path = 1024;

using Floats = float[3];
struct StoredBeginning {
  uint32_t path;
  int32_t light;
  Floats origin, normal, direction;
  EmissionDensity density;
};
struct StoredScattering {
  uint32_t path, at, number;
  Floats position, normal, next;
  float pdf, pdf_unguided;
};

void store(const Vec3f& vector, Floats& to) {
  for (int i = 0; i < 3; ++i) to[i] = vector[i];
}
Vec3f stored_vector(const Floats& from) { return {from[0], from[1], from[2]}; }
bool is_density(float value) { return value >= 0 && std::isfinite(value); }

}  // namespace

void LightPathUse::write(ByteWriter& writer) const {
  writer.put_array(arrived_);
  writer.put(paths_);
  writer.put(noise_);
  emission_.write(writer);
  scattering_.write(writer);
}

void LightPathUse::read(ByteReader& reader) {
  arrived_ = reader.get_array<double>(probes_.size());
  paths_ = reader.get<double>();
  noise_ = reader.get<Noise>();
  emission_.read(reader);
  scattering_.read(reader);
}

/// Of the point that a path begins at: what densities of emission go by.
void LightPathUse::Seen::write(ByteWriter& writer) const {
  std::vector<StoredBeginning> of_beginnings;
  for (const LightPathBeginning& beginning : beginnings) {
    const LightPathStart& start = beginning.start;
    StoredBeginning stored{};
    stored.path = beginning.path;
    stored.light = start.light;
    store(start.emitted.origin.position, stored.origin);
    store(start.emitted.origin.ng, stored.normal);
    store(start.emitted.ray.direction, stored.direction);
    stored.density = start.density;
    of_beginnings.push_back(stored);
  }
  std::vector<StoredScattering> of_scatterings;
  for (const LightScattering& event : scatterings) {
    StoredScattering stored{};
    stored.path = event.path;
    stored.at = event.at;
    stored.number = event.number;
    store(event.position, stored.position);
    store(event.normal, stored.normal);
    store(event.next, stored.next);
    stored.pdf = event.pdf;
    stored.pdf_unguided = event.pdf_unguided;
    of_scatterings.push_back(stored);
  }
  writer.put(paths);
  writer.put_array(of_beginnings);
  writer.put_array(of_scatterings);
  writer.put_array(arrivals);
}

LightPathUse::Seen LightPathUse::read_seen(ByteReader& reader) const {
  Seen seen;
  seen.paths = reader.get<uint32_t>();
  bool is_sound = seen.paths <= most_pilot_paths;
  for (const StoredBeginning& stored : reader.get_array<StoredBeginning>()) {
    const bool is_next = seen.beginnings.empty() || stored.path > seen.beginnings.back().path;
    is_sound = is_sound && is_next && stored.light >= 0 && size_t(stored.light) < light_count_ &&
               is_density(stored.density.endpoint) && is_density(stored.density.rest);
    LightPathBeginning beginning;
    beginning.path = stored.path;
    beginning.start.light = stored.light;
    beginning.start.emitted.origin.position = stored_vector(stored.origin);
    beginning.start.emitted.origin.ng = stored_vector(stored.normal);
    beginning.start.emitted.ray.direction = stored_vector(stored.direction);
    beginning.start.density = stored.density;
    seen.beginnings.push_back(beginning);
  }
  const uint64_t end = seen.beginnings.empty() ? 0 : uint64_t(seen.beginnings.back().path) + 1;
  is_sound = is_sound && end <= uint64_t(most_vertices_of_path) * seen.paths;
  for (const StoredScattering& stored : reader.get_array<StoredScattering>()) {
    is_sound = is_sound && stored.path < end && stored.at <= most_vertices_before &&
               is_density(stored.pdf) && is_density(stored.pdf_unguided);
    LightScattering event;
    event.path = stored.path;
    event.at = stored.at;
    event.number = stored.number;
    event.position = stored_vector(stored.position);
    event.normal = stored_vector(stored.normal);
    event.next = stored_vector(stored.next);
    event.pdf = stored.pdf;
    event.pdf_unguided = stored.pdf_unguided;
    seen.scatterings.push_back(event);
  }
  seen.arrivals = reader.get_array<Arrival>();
  for (const Arrival& arrival : seen.arrivals)
    is_sound = is_sound && arrival.probe < probes_.size() && arrival.path < end &&
               arrival.vertex >= arrival.path &&
               arrival.vertex - arrival.path <= most_vertices_before && is_density(arrival.light);
  if (!is_sound) reader.damaged("a light path in it is none of the scene's");
  return seen;
}

}  // namespace kaustik
