#pragma once
#include <array>
#include <optional>
#include <vector>

#include "kaustik/photon/lane_draw.h"
#include "kaustik/vcm/camera_path/vertices.h"

namespace kaustik {

class DiskCoverage;
class MergeDisk;

/// Light of light paths whose vertices are near the surface that a camera path has come to.
class SurfaceMerging {
 public:
  /// `walk` is at a surface. All must outlive this.
  SurfaceMerging(const CameraPathInputs& inputs, const CameraVertices& vertices, CameraWalk& walk)
      : in_(inputs), vertices_(vertices), walk_(walk), scratch_(walk.work().scratch) {}

  /// Adds it, and an estimate of its bias.
  void merge();

  /// A light vertex that merges with the vertex, and what it sends on as if no other way found it.
  struct MergedVertex {
    float beyond;  ///< PathWeights::beyond_merge()
    Spectrum light;
    Spectrum indirect;   ///< the part of it that is diffuse indirect light
    float glossy_share;  ///< BsdfValues::glossy_share() of where it comes from
  };
  /// All that are wanted, for who must know more than the sum.
  std::vector<MergedVertex> merged_vertices() const;

 private:
  /// What merges with the vertex, before it is divided by the area of the disk and the number of
  /// light paths.
  struct MergedLight {
    std::array<Spectrum, component_count> of{};  ///< by component
    Spectrum narrow;  ///< of all that is wanted, within the narrow disk: MattLight::narrow

    bool is_zero() const;
    void scale(float factor);
  };
  /// What one light vertex adds to that.
  struct MergedPart {
    Vec3f offset;  ///< from the vertex
    Component component;
    Spectrum light;
  };
  /// What a disk of merging weighs light vertices by: kernels for the disk and for the narrow one
  /// in it.
  struct DiskWeights {
    DiskBounds bounds;
    DiskKernel wide, narrow;
  };
  /// Whether of the light that the diffuse lobe reflects only what came by specular events counts.
  bool is_only_focused_wanted() const {
    return !walk_.wants(walk_.component_of(Lobes::diffuse, false));
  }
  /// What has the light vertices that merge at a matt vertex.
  const MattMerging& matt_merging() const {
    return in_.focused_matt && is_only_focused_wanted() ? *in_.focused_matt : in_.matt;
  }
  /// Of a disk around the vertex.
  DiskBounds disk_bounds(float radius) const;
  DiskWeights disk_weights(const MergeDisk& disk, const DiskBounds& bounds) const;
  /// Both leave in their last argument, if there is one, what makes up MergedLight::of.
  MergedLight merged_matt(const MergeDisk& disk, const DiskWeights& weights,
                          std::vector<MattMerging::Factors>* each) const;
  MergedLight merged(const MergeDisk& disk, const DiskWeights& weights, Lobes lobes,
                     std::vector<MergedPart>* each) const;
  /// The same, as far as it is not hidden from the vertex.
  MergedLight reached_matt(const MergeDisk& disk, const DiskWeights& weights,
                           const DiskCoverage& covered) const;
  MergedLight reached(const MergeDisk& disk, const DiskWeights& weights, Lobes lobes,
                      const DiskCoverage& covered) const;
  /// A draw for each component that has light.
  using Draws = std::array<std::optional<LaneDraw>, component_count>;
  Draws draws_of(const MergedLight& light) const;
  /// Leaves what is_reached(part) holds for of those drawn.
  template <typename IsReached>
  static void leave_drawn(const Draws& draws, const IsReached& is_reached, MergedLight& light);
  /// merge() at a gauge, with what passes its disk.
  void merge_at_gauge();
  /// visit(vertex, its flux, bsdf, path) for what passes the gauge's disk of that radius; where it
  /// is much, for one of `most_parts` parts of it at most, which is drawn and counts for all.
  template <typename Visit>
  void visit_at_gauge(float radius, uint32_t most_parts, const Visit& visit) const;
  /// The part of so many light vertices that is visited.
  struct Part {
    size_t first, step;
  };
  Part part_of(size_t vertices, uint32_t most_parts) const;
  /// A light vertex in the disk.
  struct Near {
    uint32_t number;
    float cover;   ///< MergeDisk::share()
    Vec3f offset;  ///< from the vertex
  };
  /// All that merge but for their weights; where they are many, one of `most_parts` parts of them
  /// at most, which is drawn. Returns how many parts there are.
  size_t find_near(const MergeDisk& disk, uint32_t most_parts, std::vector<Near>& near) const;
  /// visit(near, vertex, its flux as far as it counts, direction to where it comes from, bsdf,
  /// path) for what find_near() finds, which counts for all.
  template <typename Visit>
  void visit_merging(const MergeDisk& disk, uint32_t most_parts, const Visit& visit) const;
  float weight_of(const Near& near, const PathHalves& path) const;

  const CameraPathInputs& in_;
  const CameraVertices& vertices_;
  CameraWalk& walk_;
  Scratch& scratch_;
};

}  // namespace kaustik
