#pragma once
#include <optional>
#include <vector>

#include "kaustik/base/memory.h"
#include "kaustik/base/transform.h"
#include "kaustik/volume/line_knot.h"
#include "kaustik/volume/volume_samples.h"

namespace kaustik {

/// Samples in the middles of the equal cells of a box, and what is between them. Immutable,
/// thread-safe.
///
/// Samples are kept in bricks of 8³ cells; a brick whose samples are all alike is one number, so
/// what is empty costs little to keep and to cross. Along a straight line the value within a cell
/// is a polynomial of degree 3, whose integral has a closed form: integrals along lines have no
/// error but rounding.
class GridVolume {
 public:
  enum class Filter { nearest, trilinear };
  /// What lies outside of the box, and beyond the middles of the outermost cells.
  enum class Wrap { clamp, repeat, mirror };

  /// `world_from_unit`, affine, takes the cube [0, 1]³ to the box.
  GridVolume(const VolumeSamples& samples, Filter filter, Wrap wrap,
             const Transform& world_from_unit);

  /// Numbers that a grid of so many samples may have to keep: more than there are, for bricks share
  /// those on their faces.
  static double most_kept_values(const VolumeSamples& samples, Filter filter);

  int channels() const { return channels_; }
  /// Of all samples and channels.
  float least() const { return least_; }
  float largest() const { return largest_; }
  /// Of the samples of a channel.
  float mean(int channel) const { return means_[size_t(channel)]; }
  /// The shortest edge of a cell, m.
  float cell_size() const { return cell_size_; }

  /// Anywhere in the world, as the box is continued there.
  float value(const Vec3f& position, int channel) const;

  // The first channel of what lies in the box, and zero outside; of grids of one channel.
  float inside(const Vec3f& position) const;
  /// Integral over origin + t direction, `from` ≤ t ≤ `to` (may be infinite); where it exceeds
  /// `enough`, something above that.
  float integral(const Vec3f& origin, const Vec3f& direction, float from, float to,
                 float enough = infinity) const;
  struct Reach {
    bool is_reached = false;
    float distance = 0;  ///< t, if it is
    float integral = 0;  ///< of the whole line, if it is not
  };
  /// Where the integral from t = 0 on comes to `target` ≥ 0, for values that are nowhere negative;
  /// if it exceeds that before t = `to`.
  Reach reach(const Vec3f& origin, const Vec3f& direction, float to, float target) const;
  /// The integrals from t = 0 to where the line leaves cells, ascending.
  void measure(const Vec3f& origin, const Vec3f& direction, float to,
               std::vector<LineKnot>& knots) const;

  struct Separated;
  /// Of three channels that are everywhere one number times one colour: these two. Nothing if they
  /// are not.
  std::optional<Separated> separated() const;

 private:
  friend class GridCrossing;  ///< a line in pieces with bounds
  static constexpr int brick_shift = 3, brick_size = 1 << brick_shift;
  static constexpr uint32_t uniform = 0xffffffff;
  /// Bounds of values are kept for regions of 16³ cells.
  static constexpr int region_shift = brick_shift + 1;

  struct Brick {
    uint32_t block = uniform;  ///< of samples; or else
    float value = 0;           ///< of all of them
  };
  /// The part of a line in the box, in cells; t counts from `begin` on.
  struct Line {
    float at[3], along[3], inverse[3];  ///< where it begins, its direction, and one over that
    float begin, length;
  };
  struct Bounds {
    float least = 0, largest = 0;
  };
  /// The part of that in one cell or in a uniform brick.
  struct Piece {
    float begin, end, integral;
  };

  void fill_brick(const VolumeSamples& samples, Wrap wrap, const std::array<int, 3>& brick,
                  std::vector<float>& block) const;
  /// Of channels that lie together.
  size_t block_values() const {
    return size_t(sides_[0]) * size_t(sides_[1]) * size_t(sides_[2]) * size_t(channels_);
  }
  size_t brick_index(int x, int y, int z) const {
    return (size_t(z) * size_t(bricks_along_[1]) + size_t(y)) * size_t(bricks_along_[0]) +
           size_t(x);
  }
  size_t region_index(int x, int y, int z) const {
    return (size_t(z) * size_t(regions_along_[1]) + size_t(y)) * size_t(regions_along_[0]) +
           size_t(x);
  }
  /// Of all values in the brick, those between samples included.
  Bounds bounds_of(const Brick& brick) const;
  void find_bounds();
  double in_cells(const Vec3f& position, int axis) const {
    const auto& row = cells_from_world_[size_t(axis)];
    return row[0] * double(position.x) + row[1] * double(position.y) + row[2] * double(position.z) +
           row[3];
  }
  float wrapped(double at, int axis) const;
  float value_in_cells(const std::array<float, 3>& at, int channel) const;
  /// Of grids of one channel, one of the samples around the place: the mean over `u`, uniform in
  /// [0, 1), is the value there. What it leaves of `u` is uniform as well. It goes to memory once,
  /// where a value takes four rows (stochastic filtering: Pharr et al., "Filtering After Shading
  /// With Stochastic Texture Filtering", 2024).
  const float* sample_in_cells(const std::array<float, 3>& at, float& u) const;
  struct Place;
  Place place_in_cells(const std::array<float, 3>& at) const;
  std::optional<Line> line_in_box(const Vec3f& origin, const Vec3f& direction, float from,
                                  float to) const;
  template <bool trilinear, typename Step>
  void walk(const Line& line, const Step& step) const;
  template <typename Step>
  void walk(const Line& line, const Step& step) const;
  float integral(const Line& line, float enough) const;
  /// The distance counts from the begin of the line.
  Reach reach(const Line& line, float target) const;

  Filter filter_;
  Wrap wrap_;
  int channels_;
  std::array<int, 3> sides_{};  ///< samples along the edges of a block
  std::array<int, 3> size_{};   ///< samples
  std::array<int, 3> cells_{};  ///< between samples, those beyond the outermost included
  std::array<int, 3> bricks_along_{};
  /// Row by row: from the world to where cell i is from i to i + 1.
  std::array<std::array<double, 4>, 3> cells_from_world_{};
  float margin_ = 0;  ///< how far within the cells the box begins
  std::array<int, 3> regions_along_{};
  std::vector<Brick> bricks_;
  std::vector<Bounds> bounds_;  ///< of regions, in grids of one channel
  UnsetVector<float> values_;   ///< block by block, x fastest, channels of a place together
  float least_ = 0, largest_ = 0, cell_size_ = 0;
  std::vector<float> means_;
};

struct GridVolume::Separated {
  GridVolume density;  ///< of one channel
  Vec3f color;         ///< of linear Rec. 709, its largest channel 1
};

}  // namespace kaustik
