#pragma once
#include "kaustik/base/bytes.h"
#include "kaustik/scene/scene.h"

namespace kaustik {

/// The discs of merging in media: their radius is so many widths of a pixel at the distance from
/// the camera, whatever path has led there, so that all ways of finding a path know it. Immutable.
class MediumDisks {
 public:
  MediumDisks() = default;
  /// Radii of `widths` pixels, or of `given` > 0, m. `mean_length`: of segments in media, m.
  MediumDisks(const Scene& scene, float widths, float given, float mean_length);

  /// All but the camera, and the same back; throws as ByteReader does.
  void write(ByteWriter& writer) const;
  static MediumDisks read(ByteReader& reader, const Scene& scene);

  /// These with `shrinkage` times the area.
  MediumDisks shrunk(float shrinkage) const;
  /// m. No more than a share of the mean free path, within which light in a medium hardly varies,
  /// but for a radius that was given.
  float radius(const Vec3f& position, const Medium& medium) const;
  /// PathVertex::merge_volume: the disc's area times the mean free path, and times how much more
  /// often light paths' vertices are found there than those of free flight, since they are sure to
  /// be scattered within their segments.
  float merge_volume(const Vec3f& position, const Medium& medium) const;

 private:
  Vec3f camera_{0, 0, 0};
  float at_lens_ = 0;       ///< of the radius, m …
  float per_distance_ = 0;  ///< … and its growth
  float given_ = 0;
  float mean_free_paths_ = 0.05f;  ///< at most
  float mean_length_ = 1;
};

}  // namespace kaustik
