#include "kaustik/photon/volume_photon_map.h"

#include "kaustik/base/parallel.h"
#include "kaustik/medium/segment_transmittance.h"
#include "kaustik/photon/kd_tree/kd_tree.h"
#include "kaustik/photon/volume_sight.h"

namespace kaustik {
namespace {

using PhotonTree = KdTree<3, Vec3f, uint32_t>;

/// Distance of the k-th nearest other photon, or of the farthest there is; zero for photons that
/// lie at one place.
float neighbor_distance(const PhotonTree& tree, const Vec3f& position, int neighbors,
                        PhotonTree::Neighbors& found) {
  tree.nearest(position, size_t(neighbors) + 1, PhotonTree::unlimited, KdAcceptAll{}, found);
  return found.size() > 1 ? std::sqrt(found.farthest_sq()) : 0.0f;
}

}  // namespace

VolumePhotonMap::VolumePhotonMap(std::vector<VolumePhoton> photons, int neighbors, float shrinkage,
                                 const Scene* scene)
    : scene_(scene) {
  order_photons(std::move(photons), neighbors, shrinkage);
  std::vector<DiscHierarchy::Disc> discs;
  discs.reserve(photons_.size());
  for (const VolumePhoton& photon : photons_) discs.push_back({photon.position, photon.radius});
  discs_ = DiscHierarchy(std::move(discs));
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

Spectrum VolumePhotonMap::radiance(const Ray& ray, float length, const Medium& medium,
                                   const Wavelengths& wavelengths, const Sampler& sampler,
                                   const Work& work) const {
  Spectrum sum;
  const auto parts = work.scratch.list<VolumePart>();
  SegmentTransmittance left(medium, {ray.origin, ray.direction, length}, wavelengths, sampler,
                            work.scratch);
  discs_.visit_met(ray, length, [&](size_t i, float along, float distance_sq) {
    const VolumePhoton& photon = photons_[i];
    if (photon.medium != &medium) return;
    const float radius_sq = sqr(photon.radius);
    const float kernel = 3 * inv_pi * sqr(1 - distance_sq / radius_sq) / radius_sq;
    const float phase = medium.phase().eval(photon.direction.unpack(), -ray.direction);
    const Spectrum light = photon.flux * left.to(along) * (kernel * phase);
    sum += light;
    if (scene_) parts->push_back({i, ray.origin + ray.direction * along, light});
  });
  if (!scene_ || sum.is_zero()) return sum;
  return visible_from_segment(*scene_, discs_, *parts, sum,
                              sampler.fork(Fork::volume_sight).next_1d(), work.rays);
}

}  // namespace kaustik
