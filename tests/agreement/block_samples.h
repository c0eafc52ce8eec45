#pragma once
// Pictures of scenes that ship as luminances of blocks of pixels, from renders that are independent
// of one another. Block means are nearer to a normal distribution than pixels, and hardly blurred.
// Pixels by themselves: pixel_tests.h.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace kaustik::agreement {

/// Independent renders of each picture; sign flips of their differences give 2¹⁵ patterns.
inline constexpr int replicate_total = 16;
inline constexpr int block_pixels = 4;  ///< width and height of a block

/// One row per render: the luminance of each block, row by row.
using Replicates = std::vector<std::vector<float>>;
/// By the component's name.
using Components = std::map<std::string, Replicates>;

/// What is rendered `replicate_total` times, each with a seed of its own: a function of these
/// numbers alone.
struct BlockRender {
  std::string scene;  ///< of scenes/, or a file such as "docs/gallery/bsdf_phong.xml"
  int size = 256;     ///< pixels; a multiple of `block_pixels`
  std::string integrator;
  std::string components;            ///< "direct,caustic"; `whole_picture`: all of them as one
  std::string setting;               ///< one property besides, "integrator.aim=none"; or ""
  uint32_t passes = 1, samples = 1;  ///< of each render; samples per pixel and pass
  uint64_t first_seed = 1;
  /// Radius of merging as a share of the scene's bounding sphere; 0: the method's own.
  double radius_share = 0;
};

/// A component that is the sum of all.
inline constexpr const char* whole_picture = "picture";

/// The layer of what an integrator tells of its own bias, beside the components.
inline constexpr const char* bias_layer = "bias";

/// The same renders twice.
struct Rendered {
  Components blocks;  ///< those that were asked for, and `bias_layer` where it is told
  Components pixels;  ///< those that were asked for
};
Rendered render_replicates(const BlockRender& render);

/// Of the blocks alone: Rendered::blocks but for the bias.
Components render_blocks(const BlockRender& render);

/// An EXR with one pixel per block: the mean of the renders, such as "caustic", with 32 bits, and
/// by what share of that each render differs, such as "caustic.07", with 16. So rounding takes less
/// than a thousandth of the noise, however small that is.
void write_blocks(const Components& components, const std::string& path);
/// Throws Error if it is no such file.
Components read_blocks(const std::string& path);

/// The same with means over `factor` × `factor` blocks, of pictures `columns` blocks wide.
Replicates coarser(const Replicates& blocks, int columns, int factor);
/// The mean of each block over the renders.
std::vector<double> mean_of_renders(const Replicates& replicates);

}  // namespace kaustik::agreement
