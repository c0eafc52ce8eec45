#pragma once
#include <string>

#include "kaustik/base/scratch.h"
#include "kaustik/photon/coverage/surface_sight.h"
#include "kaustik/photon/kd_tree/sided_tree.h"
#include "kaustik/transport/vertex.h"

namespace kaustik {

/// How neighbouring photons are weighted; every kernel is normalised on the disk of radius r.
enum class Kernel {
  constant,     ///< 1/(π r²)
  cone,         ///< (1 − d/(k r)) / ((1 − 2/(3k)) π r²) (Jensen 1996)
  epanechnikov  ///< 2 (1 − d²/r²) / (π r²)
};

/// How a density is estimated.
struct EstimateSettings {
  int neighbors = 50;               ///< photons, of different light paths, to find; 0: no light
  float maximum_radius = infinity;  ///< m
  Kernel kernel = Kernel::constant;
  float cone_constant = 1;  ///< k ≥ 1 of the cone
};

/// Whether photons that something opaque hides from the point count. They do not if there is a
/// sight: one photon is drawn by the number `u` in [0, 1) and tells for all (LaneDraw).
struct PhotonVisibility {
  const SurfaceSight* sight = nullptr;
  float u = 0;
};

/// A distance from the centre, relative to the disk's radius, distributed as the kernel's weight on
/// the disk; from an even number in [0, 1).
float kernel_distance(const EstimateSettings& settings, float u);

/// What an estimate was made of.
struct DensityEstimate {
  Spectrum value;    ///< irradiance W/m² or radiance W/(sr·m²)
  float radius = 0;  ///< m
  int found = 0;     ///< photons within it, the one that sets it included
};

/// Photons in a kd-tree and the estimates from them (Schregle 1998, corrected). The
/// farthest of k neighbours only sets the radius; the kernel sums the k − 1 nearer ones, which
/// makes the estimate unbiased for even density (García et al. 2012). With fewer than k within the
/// maximum radius, that is the radius, and all count. That holds for independent things, which
/// light paths are and the photons of one path are not: light that is trapped leaves clusters. So
/// neighbours are paths, each as near as its nearest photon, and all photons of the k − 1 nearer
/// paths that lie within the radius count. Immutable; estimates are thread-safe.
class PhotonMap {
 public:
  PhotonMap() = default;
  /// Where `stop` is requested the map is left empty.
  PhotonMap(std::vector<Vec3f> positions, std::vector<Photon> photons,
            const std::stop_token& stop = {});
  /// A map that was built before, of so large a mean_flux().
  PhotonMap(SidedTree<Photon> tree, float mean_flux)
      : tree_(std::move(tree)), mean_flux_(mean_flux) {}

  size_t size() const { return tree_.size(); }
  bool empty() const { return tree_.empty(); }
  size_t size_in_bytes() const { return tree_.size_in_bytes(); }
  /// Mean over photons of the largest lane of flux, W.
  float mean_flux() const { return mean_flux_; }
  const KdTree<3, Vec3f, Photon>& tree() const { return tree_.tree(); }
  const PhotonSides& sides() const { return tree_.sides(); }
  /// See SidedTree.
  float typical_radius(int neighbors, float quantile) const {
    return tree_.typical_radius(neighbors, quantile);
  }

  /// Irradiance on the side of `vertex` from which it is seen. Photons that arrived on the other
  /// side are rejected during the search.
  DensityEstimate irradiance(const SurfaceVertex& vertex, const EstimateSettings& settings,
                             Scratch& scratch, const PhotonVisibility& visibility = {}) const;
  /// The same at a bare point of a surface whose geometric normal on the lit side is `side`.
  DensityEstimate irradiance(const Vec3f& position, const Vec3f& side,
                             const EstimateSettings& settings, Scratch& scratch,
                             const PhotonVisibility& visibility = {}) const;
  /// Radiance that the lobes of `vertex` send toward its wo; for purely diffuse lobes the same as
  /// f_d times the irradiance.
  DensityEstimate radiance(const SurfaceVertex& vertex, Lobes lobes,
                           const EstimateSettings& settings, Scratch& scratch,
                           const PhotonVisibility& visibility = {}) const;

  /// Photons near a point, for importance sampling: calls visit(photon, position) for each of at
  /// most `count` that arrived on the side `side`.
  template <typename Visit>
  void visit_nearest(const Vec3f& position, const Vec3f& side, int count, float maximum_radius,
                     Scratch& scratch, const Visit& visit) const {
    const auto borrowed = scratch.borrow<Neighbors>();
    Neighbors& neighbors = *borrowed;
    tree_.nearest(position, side, false, count, maximum_radius, neighbors);
    for (size_t i = 0; i < neighbors.size(); ++i)
      visit(tree().data(neighbors.index(i)), tree().key(neighbors.index(i)));
  }

 private:
  using Neighbors = SidedTree<Photon>::Neighbors;
  /// What an estimate sums: the first `count` of the neighbours that were found.
  struct Disk {
    float radius_sq = 0;
    size_t count = 0, found = 0;
  };
  /// What an estimate needs meanwhile.
  struct Lists;
  /// `both_sides` as for SidedTree::nearest(). Leaves the neighbours in `lists`.
  Disk find_disk(const Vec3f& position, const Vec3f& side, bool both_sides,
                 const EstimateSettings& settings, Lists& lists) const;
  /// What is left of what the first neighbours add, of which there are running sums. `normal`: of
  /// the surface.
  Spectrum visible(const Lists& lists, const Vec3f& normal,
                   const PhotonVisibility& visibility) const;
  /// How many of the first `count` neighbours there are until `paths` different paths are met;
  /// count + 1: there are fewer.
  size_t count_until(Lists& lists, size_t count, size_t paths) const;

  SidedTree<Photon> tree_;
  float mean_flux_ = 0;
};

/// Radius beyond which `neighbors` photons of mean flux `mean_flux` make less than the least
/// visible radiance: sqrt(N Φ̄/(π L_min)) (Schregle 1998). Infinite for L_min = 0.
float radius_of_least_radiance(int neighbors, float mean_flux, float minimum_radiance);

/// Cap on the gather radius in pass `index` (from 0), given that of pass 0, for α = 2/3 (Knaus and
/// Zwicker 2011, eq. 15: r²_{i+1} = r²_i (i + α)/(i + 1), in closed form).
float pass_radius(float first_radius, uint32_t index);

}  // namespace kaustik
