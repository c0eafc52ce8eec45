#include "kaustik/vcm/gathering/scattered_light.h"

#include <algorithm>
#include <cmath>

#include "kaustik/base/parallel.h"
#include "kaustik/base/to_integer.h"

namespace kaustik {
namespace {

/// One path in so many tells places, the others what light is there; in fewer where there would be
/// more places than needed.
constexpr uint32_t least_paths_per_place = 4;
constexpr size_t enough_places = 1 << 14;
/// Places within a disk of the first pass, and at least.
constexpr float first_places = 4, least_places = 1.5f;
/// Who looks from so many radii off, in the first pass, does not see how disks blur.
constexpr float first_distance = 4;
/// What lies farther from a plane, in radii, or faces another way, is another surface.
constexpr float most_height = 0.25f, least_cosine = 0.7f;
/// Where vertices are farther off the middle of their disk, on average, in radii, it is not all
/// surface: those of half a disk are 0.42 off. Fewer vertices would be farther off by chance.
constexpr float most_off_center = 0.3f;
constexpr int telling_vertices = 24;

bool is_same_surface(const Vec3f& offset, const CoarseNormal& side, const Vec3f& normal,
                     float radius) {
  return std::fabs(dot(offset, normal)) <= most_height * radius &&
         side.dot(normal) >= least_cosine * side.length();
}

/// As that of a thin wall.
bool is_back(const CoarseNormal& side, const Vec3f& normal) {
  return side.dot(normal) <= -least_cosine * side.length();
}

}  // namespace

class ScatteredLight::Builder {
 public:
  Builder(const LightVertices& light, float shrinkage, const std::stop_token& stop)
      : light_(light),
        shrinkage_(shrinkage),
        stop_(stop),
        paths_per_place_(std::max(least_paths_per_place, uint32_t(data().size() / enough_places))),
        neighbors_(to_integer(
            std::round(float(paths_per_place_) * std::max(least_places, first_places * shrinkage)),
            2, 1 << 30)) {
    for (size_t i = 0; i < data().size(); ++i)
      if (!data()[i].specular && tells_place(data()[i])) numbers_.push_back(uint32_t(i));
  }

  void build(ScatteredLight& result) {
    find_radius();
    if (!(radius_ > 0) || stop_.stop_requested()) return;
    std::vector<Vec3f> positions(numbers_.size());
    std::vector<Place> places(numbers_.size());
    parallel_blocks(numbers_.size(), 256, [&](size_t begin, size_t end, size_t) {
      std::vector<uint32_t> near;
      for (size_t p = begin; p < end && !stop_.stop_requested(); ++p) {
        positions[p] = vertices().key(numbers_[p]);
        places[p] = place_at(p, near);
      }
    });
    if (stop_.stop_requested()) return;
    result.tree_ = {std::move(positions), std::move(places), stop_};
    result.radius_ = radius_;
    result.least_distance_ = first_distance / shrinkage_ * radius_;
  }

 private:
  const KdTree<3, Vec3f, LightVertexData>& vertices() const { return light_.tree.tree(); }
  std::span<const LightVertexData> data() const { return vertices().data(); }
  bool tells_place(const LightVertexData& vertex) const {
    // Paths are known by where their vertices begin.
    return (vertex.path * 0x9e3779b9u >> 8) % paths_per_place_ == 0;
  }

  /// The median of disks around places that hold as many vertices as are wanted.
  void find_radius() {
    reaches_.assign(numbers_.size(), infinity);
    std::vector<float> radii = reaches_;
    const int most = std::max(neighbors_, telling_vertices);
    parallel_blocks(numbers_.size(), 256, [&](size_t begin, size_t end, size_t) {
      SidedTree<LightVertexData>::Neighbors near;
      for (size_t p = begin; p < end && !stop_.stop_requested(); ++p) {
        light_.tree.nearest(vertices().key(numbers_[p]), data()[numbers_[p]].side.unpack(), false,
                            most + 1, infinity, near);
        if (!near.complete()) continue;
        reaches_[p] = std::sqrt(near.farthest_sq());
        // As if they were spread evenly.
        radii[p] = reaches_[p] * std::sqrt(float(neighbors_) / float(most));
      }
    });
    if (numbers_.empty()) return;
    const auto middle = radii.begin() + std::ptrdiff_t(radii.size() / 2);
    std::nth_element(radii.begin(), middle, radii.end());
    if (std::isfinite(*middle)) radius_ = *middle;
  }

  Place place_at(size_t p, std::vector<uint32_t>& near) const {
    const Vec3f position = vertices().key(numbers_[p]);
    Place place;
    place.side = data()[numbers_[p]].side;
    // Few vertices do not show where the surface ends: then those farther off are asked, too.
    const float reach = std::max(radius_, reaches_[p]);
    if (!std::isfinite(reach)) return place;
    const Vec3f normal = place.side.unpack();
    near.clear();
    // On whatever side: walls beside a floor are to be seen.
    vertices().within(position, sqr(reach), [&](uint32_t index, float) { near.push_back(index); });
    Spectrum flux;
    Vec3f offsets(0, 0, 0);
    size_t count = 0;
    for (const uint32_t index : near) {
      const LightVertexData& vertex = data()[index];
      if (is_back(vertex.side, normal)) continue;
      const Vec3f offset = vertices().key(index) - position;
      if (!is_same_surface(offset, vertex.side, normal, reach)) return place;
      offsets += offset;
      ++count;
      if (!vertex.specular && !tells_place(vertex) && length_sq(offset) < sqr(radius_))
        flux += vertex.flux.spectrum();
    }
    place.is_whole = length(offsets) <= most_off_center * reach * float(count);
    const float told_share = 1 - 1 / float(paths_per_place_);
    place.irradiance = flux * (inv_pi / (sqr(radius_) * told_share * float(light_.path_count)));
    return place;
  }

  const LightVertices& light_;
  float shrinkage_;
  const std::stop_token& stop_;
  uint32_t paths_per_place_;
  int neighbors_;
  std::vector<uint32_t> numbers_;  ///< of the vertices that are places
  std::vector<float> reaches_;     ///< of disks around them that tell whether all is surface, m
  float radius_ = 0;
};

ScatteredLight::ScatteredLight(const LightVertices& light, float shrinkage,
                               const std::stop_token& stop) {
  Builder(light, shrinkage, stop).build(*this);
}

bool ScatteredLight::lookup(const Vec3f& position, const Vec3f& normal, float distance,
                            Scratch& scratch, Spectrum& irradiance) const {
  if (empty() || distance < least_distance_) return false;
  const auto borrowed = scratch.borrow<SidedTree<Place>::Neighbors>();
  SidedTree<Place>::Neighbors& near = *borrowed;
  tree_.nearest(position, normal, false, 1, radius_, near);
  if (near.empty()) return false;
  const Place& place = tree_.tree().data(near.index(0));
  const Vec3f offset = tree_.tree().key(near.index(0)) - position;
  if (!place.is_whole || !is_same_surface(offset, place.side, normal, radius_)) return false;
  irradiance = place.irradiance.spectrum();
  return true;
}

}  // namespace kaustik
