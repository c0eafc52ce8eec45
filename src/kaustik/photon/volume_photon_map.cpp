#include "kaustik/photon/volume_photon_map.h"

#include <array>
#include <bit>

#include "kaustik/base/parallel.h"
#include "kaustik/photon/kd_tree.h"

namespace kaustik {
namespace {

using PhotonTree = KdTree<3, Vec3f, uint32_t>;

/// A segment as box tests want it.
struct Segment {
  Vec3f origin, inverse_direction;
  float length;

  bool meets(const Bounds3f& box) const {
    float near = 0, far = length;
    for (int axis = 0; axis < 3; ++axis) {
      const float a = (box.min[axis] - origin[axis]) * inverse_direction[axis];
      const float b = (box.max[axis] - origin[axis]) * inverse_direction[axis];
      // 0 · ∞ on the border of a slab along the ray is not a number: the comparisons leave it out.
      near = std::max(near, std::min(a, b));
      far = std::min(far, std::max(a, b));
    }
    return near <= far;
  }
};

/// Distance of the k-th nearest other photon, or of the farthest there is; zero for photons that
/// lie at one place.
float neighbor_distance(const PhotonTree& tree, const Vec3f& position, int neighbors,
                        PhotonTree::Neighbors& found) {
  tree.nearest(position, size_t(neighbors) + 1, PhotonTree::unlimited, KdAcceptAll{}, found);
  return found.size() > 1 ? std::sqrt(found.farthest_sq()) : 0.0f;
}

}  // namespace

VolumePhotonMap::VolumePhotonMap(std::vector<VolumePhoton> photons, int neighbors,
                                 float shrinkage) {
  order_photons(std::move(photons), neighbors, shrinkage);
  build_boxes();
}

/// Into the order of a kd-tree, in which neighbours in the list are neighbours in space.
void VolumePhotonMap::order_photons(std::vector<VolumePhoton> photons, int neighbors,
                                    float shrinkage) {
  std::vector<Vec3f> positions(photons.size());
  std::vector<uint32_t> indices(photons.size());
  for (size_t i = 0; i < photons.size(); ++i) {
    positions[i] = photons[i].position;
    indices[i] = uint32_t(i);
  }
  PhotonTree tree;
  tree.assign(std::move(positions), std::move(indices));
  photons_.resize(photons.size());
  parallel_blocks(photons.size(), 1024, [&](size_t begin, size_t end, size_t) {
    PhotonTree::Neighbors found;
    for (size_t i = begin; i < end; ++i) {
      photons_[i] = photons[tree.data(uint32_t(i))];
      photons_[i].radius =
          shrinkage * neighbor_distance(tree, photons_[i].position, neighbors, found);
    }
  });
  float largest = 0;
  for (const VolumePhoton& photon : photons_) largest = std::max(largest, photon.radius);
  // What has no neighbour at a distance gets a disc too; photons all at one place have none.
  if (!(largest > 0)) photons_.clear();
  for (VolumePhoton& photon : photons_)
    if (!(photon.radius > 0)) photon.radius = largest;
}

void VolumePhotonMap::build_boxes() {
  if (photons_.empty()) return;
  const size_t leaves = (photons_.size() + leaf_size - 1) / leaf_size;
  first_leaf_ = std::bit_ceil(leaves);
  boxes_.assign(2 * first_leaf_, Bounds3f());
  for (size_t i = 0; i < photons_.size(); ++i) {
    const Vec3f reach(photons_[i].radius);
    boxes_[first_leaf_ + i / leaf_size].extendBy(photons_[i].position - reach);
    boxes_[first_leaf_ + i / leaf_size].extendBy(photons_[i].position + reach);
  }
  for (size_t node = first_leaf_ - 1; node > 0; --node)
    for (const size_t child : {2 * node, 2 * node + 1})
      if (!boxes_[child].isEmpty()) boxes_[node].extendBy(boxes_[child]);
}

Spectrum VolumePhotonMap::leaf_radiance(size_t leaf, const Ray& ray, float length,
                                        const Medium& medium) const {
  Spectrum sum;
  const size_t begin = leaf * leaf_size, end = std::min(begin + leaf_size, photons_.size());
  for (size_t i = begin; i < end; ++i) {
    const VolumePhoton& photon = photons_[i];
    const Vec3f to_photon = photon.position - ray.origin;
    const float along = dot(to_photon, ray.direction);
    if (!(along > 0 && along < length)) continue;
    const float radius_sq = sqr(photon.radius);
    const float distance_sq = length_sq(to_photon - ray.direction * along);
    if (!(distance_sq < radius_sq) || photon.medium != &medium) continue;
    const float kernel = 3 * inv_pi * sqr(1 - distance_sq / radius_sq) / radius_sq;
    const float phase = medium.phase().eval(photon.direction.unpack(), -ray.direction);
    sum += photon.flux * medium.transmittance(along) * (kernel * phase);
  }
  return sum;
}

Spectrum VolumePhotonMap::radiance(const Ray& ray, float length, const Medium& medium) const {
  Spectrum sum;
  if (photons_.empty()) return sum;
  const Vec3f& d = ray.direction;
  const Segment segment{ray.origin, {1 / d.x, 1 / d.y, 1 / d.z}, length};
  // A node's sibling waits while it is visited: one for each level at most.
  std::array<size_t, 64> waiting;
  size_t count = 0;
  waiting[count++] = 1;
  while (count > 0) {
    const size_t node = waiting[--count];
    if (boxes_[node].isEmpty() || !segment.meets(boxes_[node])) continue;
    if (node >= first_leaf_) {
      sum += leaf_radiance(node - first_leaf_, ray, length, medium);
    } else {
      waiting[count++] = 2 * node + 1;
      waiting[count++] = 2 * node;
    }
  }
  return sum;
}

}  // namespace kaustik
