#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kaustik/base/place.h"
#include "kaustik/base/transform.h"

namespace kaustik {

/// A regular grid of numbers.
struct DenseGrid {
  std::array<size_t, 3> size{};  ///< samples along x, y, z
  std::vector<float> samples;    ///< x runs fastest
  Transform to_world;            ///< of the unit cube, which the cells of the samples fill
  /// Along each axis: a sample is the mean of the cube of so many voxels. 1: it is a voxel.
  int voxels_per_sample = 1;
};

/// Reads a grid of floats of a file of NanoVDB (version 32), whose bytes may be packed by zlib, all
/// around its active voxels with a margin of one voxel. Voxels are averaged where there are more
/// than `most_samples`. What no node holds is 0. Throws Error(input) at `place` if the file has no
/// such grid, or is damaged, or packed by Blosc.
/// Layout: Museth, NanoVDB: A GPU-Friendly and Portable VDB Data Structure, SIGGRAPH 2021, and
/// nanovdb/NanoVDB.h.
DenseGrid read_nanovdb(std::span<const uint8_t> file, const std::string& grid, size_t most_samples,
                       const Place& place);

/// Whether bytes begin as a file of NanoVDB.
bool is_nanovdb(std::span<const uint8_t> file);

}  // namespace kaustik
