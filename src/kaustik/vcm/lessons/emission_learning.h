#pragma once
#include <memory>
#include <vector>

#include "kaustik/vcm/lessons/guide_map.h"
#include "kaustik/vcm/lessons/light_path_emission.h"

namespace kaustik {

/// Learns emission from light paths whose use is known (after lightweight photon mapping, Grittmann
/// et al. 2018, and the variance-aware target of Rath et al. 2020). With f the use of a path and q
/// the density with which it was emitted, the second moment of an estimate by another density p is
/// Σ f² q/p, up to a factor. It is least where lights are chosen by the root of their part of it,
/// and the directions of each light by a GuideSquare. What a light aims at specular objects takes
/// from the rest: how much of it is left is learned by the same sum.
class EmissionLearning {
 public:
  /// Learns on top of `plain`, which must outlive this and whatever is learned.
  explicit EmissionLearning(const LightPathEmission& plain);
  ~EmissionLearning();

  /// A path that began with `start` was of use `use`, in any unit.
  void add(const LightPathStart& start, double use);
  size_t size() const { return paths_.size(); }
  void clear() { paths_.clear(); }

  /// The paths so far, and the same back. Reading throws as ByteReader does.
  void write(ByteWriter& writer) const;
  void read(ByteReader& reader);

  /// What the paths so far teach. Null where it does not pay: of two halves of the paths, each
  /// would be worth about as much with what the other has taught.
  std::shared_ptr<const LightPathEmission> learned() const;
  /// Σ f² q/p over all paths so far: noise that is left by `emission`, which was learned on top of
  /// the same plain one or is that.
  double second_moment(const LightPathEmission& emission) const;

 private:
  /// A path that was of use.
  struct Path {
    int light = -1;
    GuideMap::Place place;
    float plain = 0;    ///< density of its ray once the light is chosen, by the plain emission …
    float own = 0;      ///< … and by the light's own distribution alone
    double weight = 0;  ///< f² q
  };
  struct OfLight;
  const GuideMap& map_of(int light);
  /// Density of a path's ray once the light is chosen, where such a share of its rays is aimed.
  double plain_pdf(const Path& path, float aimed) const;
  std::vector<LightPathEmission::Guide> learn(size_t first, size_t step) const;
  double second_moment(const LightPathEmission& emission, size_t first, size_t step) const;

  const LightPathEmission& plain_;
  std::vector<std::shared_ptr<const GuideMap>> maps_;  ///< of lights whose paths were of use
  std::vector<Path> paths_;
};

}  // namespace kaustik
