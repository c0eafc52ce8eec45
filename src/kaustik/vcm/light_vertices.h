#pragma once
#include <algorithm>
#include <span>
#include <stop_token>
#include <vector>

#include "kaustik/base/stored_spectrum.h"
#include "kaustik/geometry/ray.h"
#include "kaustik/medium/medium.h"
#include "kaustik/photon/disc_hierarchy.h"
#include "kaustik/photon/kd_tree/sided_tree.h"
#include "kaustik/transport/gauge_disks.h"
#include "kaustik/transport/path_weights.h"
#include "kaustik/vcm/lessons/light_path_emission.h"
#include "kaustik/vcm/lessons/scatter_learning.h"

namespace kaustik {

/// What a vertex of a light path tells, wherever the path is completed.
struct LightVertexData {
  StoredSpectrum flux;        ///< W that arrives, were this the only path
  PackedDirection direction;  ///< toward the vertex before
  CoarseNormal side;          ///< geometric normal on the side on which it arrived
  uint8_t on_front = 1;       ///< whether that side is the side of the surface's own normal
  bool specular = true;       ///< all events before it were specular
  uint16_t before = 0;        ///< vertices before it, the light's point included
  uint32_t path = 0;          ///< where the path's vertices begin
  float pdf_next_event = 0;   ///< see PathHalves
};

/// A vertex that can be met again, to be connected.
struct ConnectibleVertex {
  Ray ray;  ///< that met the surface; in a medium with the direction alone, and its origin there
  Hit hit;
  LightVertexData data;
  const Medium* medium = nullptr;  ///< that it arrived through
  bool in_medium = false;          ///< flux is what is scattered there
};

/// A vertex in a medium that may be merged. It is a point of the segment between the path's
/// vertices where light is sure to be scattered (LightMediumVertex), and not one of those itself.
struct MergeableMediumVertex {
  StoredSpectrum flux;        ///< W scattered, were this the only path
  PackedDirection direction;  ///< toward the vertex before
  uint16_t before = 0;        ///< vertices before it, the light's point included
  uint32_t path = 0;          ///< where the path's vertices begin
  float pdf_next_event = 0;   ///< see PathHalves
  float pdf_light = 0;        ///< see PathVertex
  float to_previous = 0;      ///< see PathVertex
  const Medium* medium = nullptr;
};

/// Those of a pass, and their discs.
struct MediumVertices {
  std::vector<MergeableMediumVertex> data;
  DiscHierarchy discs;  ///< in the same order

  size_t size() const { return data.size(); }
  bool empty() const { return data.empty(); }
};

/// Where a path passes the disk of a gauge, which may be merged there. It is none of the path's
/// vertices; its flux is that which passes, its side the gauge's.
struct GaugeVertex {
  LightVertexData data;
  uint32_t gauge = 0;
  float offset_sq = 0;                   ///< from the gauge, m²
  float pdf_light = 0, to_previous = 0;  ///< see PathVertex
};

/// Those of a pass, gauge by gauge.
class GaugeVertices {
 public:
  GaugeVertices() = default;
  /// `vertices` in any order, which those of one gauge keep. `disks` must outlive this.
  GaugeVertices(const std::vector<GaugeVertex>& vertices, size_t gauges, const GaugeDisks& disks);

  bool empty() const { return vertices_.empty(); }
  const std::vector<GaugeVertex>& all() const { return vertices_; }
  std::span<const GaugeVertex> of(size_t gauge) const {
    if (vertices_.empty()) return {};
    return std::span(vertices_).subspan(begins_[gauge], begins_[gauge + 1] - begins_[gauge]);
  }
  /// Only if there are any vertices.
  const GaugeDisks& disks() const { return *disks_; }

 private:
  std::vector<GaugeVertex> vertices_;
  std::vector<size_t> begins_;
  const GaugeDisks* disks_ = nullptr;
};

/// How a path began that has left vertices.
struct LightPathBeginning {
  uint32_t path = 0;  ///< where its vertices begin
  LightPathStart start;
};

/// The vertices of the light paths of a pass. Immutable once built.
struct LightVertices {
  Wavelengths wavelengths;           ///< of flux
  std::vector<PathVertex> vertices;  ///< path by path, from the light's point on
  SidedTree<LightVertexData> tree;   ///< those that may be merged
  MediumVertices in_media;           ///< those in media that may be merged
  GaugeVertices at_gauges;           ///< those that may be merged at gauges
  /// Those of the first paths that may be connected: a choice of so many is large enough.
  std::vector<ConnectibleVertex> connectible;
  static constexpr uint32_t most_connectible_paths = 1 << 18;
  uint32_t connectible_paths() const { return std::min(path_count, most_connectible_paths); }
  uint32_t path_count = 0;
  /// Of the first paths, as many as were asked for, in their order.
  std::vector<LightPathBeginning> beginnings;
  std::vector<LightScattering> scatterings;  ///< of the same paths, those that may be guided
  uint32_t remembered_paths = 0;             ///< those of which that holds what has left vertices

  /// The vertices before `data`'s, from the light's point on.
  std::span<const PathVertex> before(const LightVertexData& data) const {
    return {vertices.data() + data.path, data.before};
  }
  const PathVertex& at(const LightVertexData& data) const {
    return vertices[size_t(data.path) + data.before];
  }
};

/// Those that light has come to by specular events alone: what only light paths find.
SidedTree<LightVertexData> focused_vertices(const LightVertices& light,
                                            const std::stop_token& stop = {});

}  // namespace kaustik
