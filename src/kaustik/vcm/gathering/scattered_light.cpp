#include "kaustik/vcm/gathering/scattered_light.h"

#include <algorithm>
#include <cmath>

#include "kaustik/base/parallel.h"
#include "kaustik/base/to_integer.h"

namespace kaustik {
namespace {

/// Vertices within a disk of the first pass, and at least.
constexpr float first_neighbors = 16;
constexpr int least_neighbors = 6;
/// One path in so many tells places, the others what light is there.
constexpr uint32_t paths_per_place = 4;
constexpr float told_share = 1 - 1.0f / paths_per_place;
/// Who looks from nearer than so many radii sees how the disk blurs the light.
constexpr float least_distance = 4;
/// What lies farther from a plane, in radii, or faces another way, is another surface.
constexpr float most_height = 0.25f, least_cosine = 0.7f;
/// Where vertices are farther off the middle of their disk, on average, in radii, it is not all
/// surface: that of half a disk is 0.42 off.
constexpr float most_off_center = 0.3f;

bool tells_place(const LightVertexData& data) {
  // Paths are known by where their vertices begin.
  return (data.path * 0x9e3779b9u >> 16) % paths_per_place == 0;
}

bool is_same_surface(const Vec3f& offset, const CoarseNormal& side, const Vec3f& normal,
                     float radius) {
  return std::fabs(dot(offset, normal)) <= most_height * radius &&
         side.dot(normal) >= least_cosine * side.length();
}

/// What most of the radii are smaller than; 0: there are none.
float usual_radius(std::vector<float> radii) {
  if (radii.empty()) return 0;
  const auto most = radii.begin() + std::ptrdiff_t(0.9 * double(radii.size()));
  std::nth_element(radii.begin(), most, radii.end());
  return *most;
}

}  // namespace

ScatteredLight::ScatteredLight(const LightVertices& light, float shrinkage,
                               const std::stop_token& stop) {
  const auto& vertices = light.tree.tree();
  const std::span<const LightVertexData> data = vertices.data();
  std::vector<uint32_t> numbers;
  for (size_t i = 0; i < data.size(); ++i)
    if (!data[i].specular && tells_place(data[i])) numbers.push_back(uint32_t(i));
  const int neighbors =
      std::max(least_neighbors, to_integer(std::round(first_neighbors * shrinkage), 1, 1 << 20));
  const float per_path = inv_pi / (told_share * float(light.path_count));
  std::vector<Vec3f> positions(numbers.size());
  std::vector<Place> places(numbers.size());
  parallel_blocks(numbers.size(), 256, [&](size_t begin, size_t end, size_t) {
    SidedTree<LightVertexData>::Neighbors near;
    for (size_t p = begin; p < end && !stop.stop_requested(); ++p) {
      const Vec3f position = positions[p] = vertices.key(numbers[p]);
      const LightVertexData& own = data[numbers[p]];
      places[p].side = own.side;
      const Vec3f normal = own.side.unpack();
      // Itself among them.
      light.tree.nearest(position, normal, false, neighbors + 1, infinity, near);
      const float radius_sq = near.farthest_sq();
      if (!near.complete() || !(radius_sq > 0)) continue;
      const float radius = places[p].radius = std::sqrt(radius_sq);
      Spectrum flux;
      Vec3f offsets(0, 0, 0);
      size_t elsewhere = 0;
      // The farthest tells the radius. It does not count, or the light would be too bright.
      for (size_t i = 0; i + 1 < near.size(); ++i) {
        const LightVertexData& of = data[near.index(i)];
        const Vec3f offset = vertices.key(near.index(i)) - position;
        if (!is_same_surface(offset, of.side, normal, radius)) {
          ++elsewhere;
          continue;
        }
        offsets += offset;
        if (!of.specular && !tells_place(of)) flux += of.flux.spectrum();
      }
      // The surface ends within the disk, or another one begins: what is there tells too little.
      if (elsewhere > 0 || length(offsets) > most_off_center * radius * float(near.size() - 2))
        places[p].radius = 0;
      places[p].irradiance = flux * (per_path / radius_sq);
    }
  });
  if (stop.stop_requested() || places.empty()) return;
  std::vector<float> radii;
  for (const Place& place : places)
    if (place.radius > 0) radii.push_back(place.radius);
  reach_ = usual_radius(std::move(radii));
  tree_ = {std::move(positions), std::move(places), stop};
}

bool ScatteredLight::lookup(const Vec3f& position, const Vec3f& normal, float distance,
                            Scratch& scratch, Spectrum& irradiance) const {
  if (empty()) return false;
  const auto borrowed = scratch.borrow<SidedTree<Place>::Neighbors>();
  SidedTree<Place>::Neighbors& near = *borrowed;
  tree_.nearest(position, normal, false, 1, std::min(reach_, distance / least_distance), near);
  if (near.empty()) return false;
  const Place& place = tree_.tree().data(near.index(0));
  if (!(place.radius > 0) || place.radius * least_distance > distance) return false;
  const Vec3f offset = tree_.tree().key(near.index(0)) - position;
  if (near.distance_sq(0) > sqr(place.radius) ||
      !is_same_surface(offset, place.side, normal, place.radius))
    return false;
  irradiance = place.irradiance.spectrum();
  return true;
}

}  // namespace kaustik
