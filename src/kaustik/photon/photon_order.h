#pragma once
#include <array>
#include <cstdint>

#include "kaustik/photon/photon.h"

namespace kaustik {

/// A photon and where it lies, as it is sorted.
struct PhotonRecord {
  PhotonRecord() = default;
  PhotonRecord(const Vec3f& position, const Photon& of)
      : coordinates{position.x, position.y, position.z}, photon(of) {}
  Vec3f position() const { return {coordinates[0], coordinates[1], coordinates[2]}; }

  std::array<float, 3> coordinates{};
  Photon photon;
};
static_assert(sizeof(PhotonRecord) == sizeof(Vec3f) + sizeof(Photon));

/// A box around photons.
struct PhotonBounds {
  Vec3f lower{infinity, infinity, infinity}, upper{-infinity, -infinity, -infinity};
  void add(const PhotonBounds& other);
  bool empty() const { return !(lower.x <= upper.x); }
};

/// An order of photons that depends on nothing but the photons and a box around all of them, in
/// which photons near one another are near one another: along a Hilbert curve (Skilling,
/// "Programming the Hilbert curve", 2004) through cubes of 1/65536 of the longest side; in one cube
/// by their positions, at one place by their bytes.
class PhotonOrder {
 public:
  explicit PhotonOrder(const PhotonBounds& bounds);
  /// How far along the curve the cube lies.
  uint64_t place_on_curve(const Vec3f& position) const;
  /// Of photons in one cube.
  static bool is_before(const PhotonRecord& a, const PhotonRecord& b);

 private:
  Vec3f lower_;
  float scale_ = 0;
};

}  // namespace kaustik
