#pragma once
#include <memory>
#include <stop_token>
#include <vector>

#include "kaustik/photon/coverage/disk_kernel.h"
#include "kaustik/photon/kd_tree/kd_tree_buckets.h"
#include "kaustik/photon/lane_draw.h"
#include "kaustik/vcm/light_vertices.h"

namespace kaustik {

/// Radius of the narrow disk that tells the bias of the wide one, relative to its: one that is
/// nearly as wide has nearly the same bias where the light comes from far within both.
inline constexpr float narrow_radius = 0.5f;

/// A disk at a matt vertex that the camera sees, and what its surface tells of the weights.
struct MattDisk {
  Vec3f center;
  Vec3f normal;  ///< geometric, unit, on the side that is seen
  float radius = 0;
  float flatness = 0;        ///< what lies farther from its plane does not count, m
  float least_cosine = 0;    ///< nor what lies on a surface that is turned away more than this
  int most_before = 0xffff;  ///< nor what has more vertices before it
  DiskEdges edges;           ///< nor what lies beyond these
  Vec3f slope{0, 0, 0}, narrow_slope{0, 0, 0};  ///< of the kernels, DiskKernel
  PathWeights::MattVertex weights;
  bool only_after_specular = false;  ///< nor, if so, other light
};

/// What merges there, W, apart for light that came by specular events only and for the rest.
struct MattLight {
  struct Sum {
    /// Σ flux · weight · cosine between the normals · (1 − distance²/radius²) · (1 + slope ·
    /// offset)
    Spectrum wide;
    /// The same with the kernel of the narrow disk, 1 − distance²/(narrow_radius · radius)², and
    /// its slope.
    Spectrum narrow;
  };
  Sum after_specular, other;
};

/// Merging at matt vertices, where light counts alike from everywhere: many light vertices at once
/// by vector instructions, for some nanoseconds each. Holds what this takes of each vertex, in the
/// order of the tree. Immutable once built.
class MattMerging {
 public:
  MattMerging() = default;
  /// Of the vertices that may be merged. `light` must outlive this. Where `stop` is requested
  /// nothing will be merged.
  MattMerging(const LightVertices& light, const PathWeights& weights,
              const std::stop_token& stop = {})
      : MattMerging(light, light.tree, weights, stop) {}
  /// Of some of them, `vertices`, which must outlive this, too.
  MattMerging(const LightVertices& light, const SidedTree<LightVertexData>& vertices,
              const PathWeights& weights, const std::stop_token& stop = {});

  /// Light that came by specular events only, and the rest.
  enum Kind { other, after_specular };
  /// The factors of flux in MattLight::Sum::wide of the vertices of a bucket.
  struct Factors {
    uint32_t bucket;
    uint16_t counting;  ///< bit i: that of vertex i is more than 0
    float wide[KdBuckets::bucket_size];
  };
  /// Adds to `each`, if there is one, the factors of all buckets where any is more than 0. Slopes
  /// make some of them negative.
  MattLight merge(const MattDisk& disk, std::vector<Factors>* each = nullptr) const;
  /// Offers the vertices of a kind, of which merge() told the factors, by their numbers: flux times
  /// factor times `reflected`. Of a disk without slopes.
  void offer(const std::vector<Factors>& each, Kind kind, const Spectrum& reflected,
             LaneDraw& draw) const;
  /// Whether anything may be within the disk.
  bool may_merge(const Vec3f& center, float radius) const;
  Vec3f position(uint32_t number) const { return buckets_->position(number); }

  /// Of 16 vertices, those of one bucket of the tree. Without initialisers, so that whoever fills
  /// it is the first to touch its memory.
  struct alignas(64) Block {
    static constexpr size_t size = KdBuckets::bucket_size;
    float flux[Spectrum::lane_count][size];
    float connection[size], beyond[size];  ///< PathWeights::MattMerge
    float side_length[size];  ///< of the sides; after floats alone, for vectors lie aligned
    int8_t side[3][size];     ///< LightVertexData::side
    uint16_t before[size];    ///< LightVertexData::before
    uint16_t most_before;     ///< of all
    uint16_t after_specular;  ///< bit i: that of vertex i
    bool same_side;           ///< all sides are alike
  };

 private:
  const KdBuckets* buckets_ = nullptr;
  std::unique_ptr<Block[]> blocks_;  ///< one for each bucket; null: nothing merges
};

}  // namespace kaustik
