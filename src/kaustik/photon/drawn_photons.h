#pragma once
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

#include "kaustik/base/stored_spectrum.h"
#include "kaustik/base/vec.h"

namespace kaustik {

/// A photon with where it comes from, which maps do not keep: to be looked at.
struct DrawnPhoton {
  /// The map that holds it.
  enum class Map : uint8_t { global, caustic, volume };

  Vec3f position{0, 0, 0};  ///< m, in the world
  StoredSpectrum flux;      ///< W, as the map has it
  Map map = Map::global;
  uint32_t light = 0;  ///< index into Scene::lights()
  uint32_t level = 0;  ///< events of its light path before
};

struct DrawnPhotons {
  /// In random order, so that the first of them are some of all, too.
  std::vector<DrawnPhoton> photons;
  uint64_t total = 0;  ///< photons that they were drawn from
};

/// Draws some of many photons without replacement, each as likely as any other: those with the
/// least of keys that are as good as random. Which ones, and their order, depend neither on the
/// order in which they are offered nor on the threads that do it. Keeps no more than a few times as
/// many as are wanted.
class PhotonDraw {
 public:
  struct Offer {
    uint64_t key;  ///< no other photon's
    DrawnPhoton photon;
  };
  explicit PhotonDraw(size_t most) : most_(most) {}

  /// From any thread.
  void offer(const std::vector<Offer>& offers);
  /// What was drawn; the last call.
  DrawnPhotons take();

 private:
  void keep_least();

  size_t most_;
  std::mutex mutex_;
  std::vector<Offer> kept_;
  uint64_t total_ = 0;
};

}  // namespace kaustik
