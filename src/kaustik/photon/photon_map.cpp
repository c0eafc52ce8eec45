#include "kaustik/photon/photon_map.h"

#include <bit>

#include "kaustik/base/log_gamma.h"
#include "kaustik/photon/lane_draw.h"

namespace kaustik {
namespace {

/// Weight of a photon at squared distance d² from the centre of a disk of radius r.
class KernelWeight {
 public:
  KernelWeight(const EstimateSettings& settings, float radius_sq)
      : kernel_(settings.kernel), inverse_radius_sq_(1 / radius_sq) {
    const float area = pi * radius_sq;
    switch (kernel_) {
      case Kernel::constant:
        scale_ = 1 / area;
        break;
      case Kernel::cone:
        slope_ = 1 / settings.cone_constant;
        scale_ = 1 / ((1 - 2.0f / 3.0f * slope_) * area);
        break;
      case Kernel::epanechnikov:
        scale_ = 2 / area;
        break;
    }
  }
  float operator()(float distance_sq) const {
    const float relative_sq = distance_sq * inverse_radius_sq_;
    switch (kernel_) {
      case Kernel::constant:
        return scale_;
      case Kernel::cone:
        return scale_ * (1 - slope_ * std::sqrt(relative_sq));
      case Kernel::epanechnikov:
        return scale_ * (1 - relative_sq);
    }
    return 0;
  }

 private:
  Kernel kernel_;
  float inverse_radius_sq_;
  float scale_ = 0, slope_ = 0;
};

/// Light paths that were met, by their numbers.
class PathSet {
 public:
  /// Empty, with room for `count`.
  void start(size_t count) {
    const size_t size = std::bit_ceil(2 * count);
    slots_.assign(size, 0);
    mask_ = size - 1;
  }
  /// False where it was met before.
  bool insert(uint32_t path) {
    const uint32_t key = path + 1;  // 0: free
    size_t slot = size_t(key * 0x9E3779B97F4A7C15u >> 32) & mask_;
    for (; slots_[slot] != 0; slot = (slot + 1) & mask_)
      if (slots_[slot] == key) return false;
    slots_[slot] = key;
    return true;
  }

 private:
  std::vector<uint32_t> slots_;
  size_t mask_ = 0;
};

}  // namespace

struct PhotonMap::Lists {
  Neighbors neighbors;
  PathSet met;
  std::vector<Spectrum> running_sums;  ///< what photons up to each of them add
};

PhotonMap::PhotonMap(std::vector<Vec3f> positions, std::vector<Photon> photons,
                     const std::stop_token& stop) {
  if (stop.stop_requested()) return;
  double sum = 0;
  for (const Photon& photon : photons) sum += photon.flux.spectrum().max_lane();
  mean_flux_ = photons.empty() ? 0 : float(sum / double(photons.size()));
  tree_ = {std::move(positions), std::move(photons), stop};
}

size_t PhotonMap::count_until(Lists& lists, size_t count, size_t paths) const {
  lists.met.start(count);
  for (size_t i = 0; i < count; ++i)
    if (lists.met.insert(tree().data(lists.neighbors.index(i)).path) && --paths == 0) return i + 1;
  return count + 1;
}

PhotonMap::Disk PhotonMap::find_disk(const Vec3f& position, const Vec3f& side, bool both_sides,
                                     const EstimateSettings& settings, Lists& lists) const {
  Neighbors& neighbors = lists.neighbors;
  const auto paths = size_t(settings.neighbors);
  for (size_t wanted = paths;; wanted = std::min(2 * wanted, size())) {
    tree_.nearest(position, side, both_sides, int(wanted), settings.maximum_radius, neighbors);
    const size_t found = neighbors.size();
    const Disk all{sqr(settings.maximum_radius), found, found};
    if (found < paths) return all;
    // Most often no path comes twice. The farthest of a complete set stands last.
    if (found == paths && count_until(lists, found, paths) == paths)
      return {neighbors.farthest_sq(), paths - 1, paths};
    if (found > paths) {
      neighbors.sort();
      const size_t needed = count_until(lists, found, paths);
      if (needed <= found) return {neighbors.distance_sq(needed - 1), needed - 1, needed};
    }
    if (!neighbors.complete() || wanted >= size()) return all;
  }
}

Spectrum PhotonMap::visible(const Lists& lists, const Vec3f& normal,
                            const PhotonVisibility& visibility) const {
  const Spectrum& sum = lists.running_sums.back();
  if (!visibility.sight || sum.is_zero()) return sum;
  return LaneDraw(lists.running_sums, visibility.u).remaining(sum, [&](size_t i) {
    const uint32_t index = lists.neighbors.index(i);
    const Vec3f side = tree().data(index).side.unpack();
    return visibility.sight->sees(dot(side, normal) < 0 ? -normal : normal, tree().key(index),
                                  side);
  });
}

DensityEstimate PhotonMap::irradiance(const Vec3f& position, const Vec3f& side,
                                      const EstimateSettings& settings, Scratch& scratch,
                                      const PhotonVisibility& visibility) const {
  DensityEstimate estimate;
  if (settings.neighbors <= 0 || empty()) return estimate;
  const auto lists = scratch.borrow<Lists>();
  const Neighbors& neighbors = lists->neighbors;
  const Disk disk = find_disk(position, side, false, settings, *lists);
  estimate.found = int(disk.found);
  estimate.radius = std::sqrt(disk.radius_sq);
  if (disk.count == 0 || !std::isfinite(disk.radius_sq) || !(disk.radius_sq > 0)) return estimate;
  const KernelWeight weight(settings, disk.radius_sq);
  Spectrum sum;
  std::vector<Spectrum>& running_sums = lists->running_sums;
  running_sums.clear();
  for (size_t i = 0; i < disk.count; ++i) {
    sum += tree().data(neighbors.index(i)).flux.spectrum() * weight(neighbors.distance_sq(i));
    running_sums.push_back(sum);
  }
  estimate.value = visible(*lists, side, visibility);
  return estimate;
}

DensityEstimate PhotonMap::irradiance(const SurfaceVertex& vertex, const EstimateSettings& settings,
                                      Scratch& scratch, const PhotonVisibility& visibility) const {
  const Vec3f& ng = vertex.point().ng;
  return irradiance(vertex.position(), vertex.on_front() ? ng : -ng, settings, scratch, visibility);
}

DensityEstimate PhotonMap::radiance(const SurfaceVertex& vertex, Lobes lobes,
                                    const EstimateSettings& settings, Scratch& scratch,
                                    const PhotonVisibility& visibility) const {
  const Lobes asked = lobes & vertex.lobes();
  const Vec3f side = vertex.on_front() ? vertex.point().ng : -vertex.point().ng;
  if (!any(asked)) return {};
  const bool is_opaque_matt =
      asked == Lobes::diffuse && vertex.is_lambertian() && !vertex.transmits();
  if (is_opaque_matt && !vertex.has_relief()) {
    DensityEstimate estimate = irradiance(vertex.position(), side, settings, scratch, visibility);
    estimate.value *= vertex.diffuse_value();
    return estimate;
  }
  DensityEstimate estimate;
  if (settings.neighbors <= 0 || empty()) return estimate;
  const auto lists = scratch.borrow<Lists>();
  const Neighbors& neighbors = lists->neighbors;
  const bool both_sides = vertex.transmits();
  const Disk disk = find_disk(vertex.position(), both_sides ? vertex.point().ng : side, both_sides,
                              settings, *lists);
  estimate.found = int(disk.found);
  estimate.radius = std::sqrt(disk.radius_sq);
  if (disk.count == 0 || !std::isfinite(disk.radius_sq) || !(disk.radius_sq > 0)) return estimate;
  const KernelWeight weight(settings, disk.radius_sq);
  const Spectrum diffuse = is_opaque_matt ? vertex.diffuse_value() : Spectrum();
  Spectrum sum;
  std::vector<Spectrum>& running_sums = lists->running_sums;
  running_sums.clear();
  for (size_t i = 0; i < disk.count; ++i) {
    const uint32_t index = neighbors.index(i);
    const Photon& photon = tree().data(index);
    const Vec3f wi = photon.incident_direction(tree().key(index), vertex.position());
    const Spectrum f = is_opaque_matt ? diffuse : vertex.eval(wi, asked);
    const float share = weight(neighbors.distance_sq(i)) *
                        (vertex.has_relief() ? vertex.irradiance_factor(wi) : 1.0f);
    sum += f * photon.flux.spectrum() * share;
    running_sums.push_back(sum);
  }
  estimate.value = visible(*lists, side, visibility);
  return estimate;
}

float kernel_distance(const EstimateSettings& settings, float u) {
  switch (settings.kernel) {
    case Kernel::constant:
      break;
    case Kernel::cone: {
      // 1 − d/k is 1 − 1/k, even, and 1/k of the cone 1 − d, which has a third of that weight.
      const float k = settings.cone_constant, even = 3 * (k - 1) / (3 * (k - 1) + 1);
      if (u < even) {
        u /= even;
        break;
      }
      u = std::min((u - even) / (1 - even), 1.0f);
      // 3 d² − 2 d³ = u.
      return 0.5f - std::sin(std::asin(1 - 2 * u) / 3);
    }
    case Kernel::epanechnikov:
      return std::sqrt(1 - std::sqrt(1 - u));
  }
  return std::sqrt(u);
}

float radius_of_least_radiance(int neighbors, float mean_flux, float minimum_radiance) {
  if (!(minimum_radiance > 0)) return infinity;
  return std::sqrt(float(neighbors) * mean_flux / (pi * minimum_radiance));
}

float pass_radius(float first_radius, uint32_t index) {
  // The product of (j + α)/(j + 1), j = 1 … index, is Γ(i + 1 + α)/(Γ(1 + α) (i + 1)!) with
  // i = index.
  constexpr double alpha = 2.0 / 3.0;
  const double i = index;
  const double log_product = log_gamma(i + 1 + alpha) - log_gamma(1 + alpha) - log_gamma(i + 2);
  return first_radius * float(std::exp(0.5 * log_product));
}

}  // namespace kaustik
