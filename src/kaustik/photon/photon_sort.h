#pragma once
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "kaustik/photon/photon_order.h"

namespace kaustik {

class ScratchFile;

/// How much may be in memory while photons are sorted, and where the rest is meanwhile.
struct SortMemory {
  size_t photons = SIZE_MAX;  ///< at a time, 60 bytes each
  std::string beside;         ///< a file, there or not, in whose folder there is room
};

/// Sorts photons, as many as there are: what does not fit into memory lies in sorted runs on the
/// disk, which are merged when they are read.
class PhotonSort {
 public:
  /// `bounds`: around all photons that will come.
  PhotonSort(const PhotonBounds& bounds, const SortMemory& memory);
  ~PhotonSort();
  /// Throws as ScratchFile does.
  void add(const PhotonRecord& record);
  /// Calls take(records) for all, in their order, with so many at a time, the last time the rest.
  /// Nothing is left then.
  void drain(size_t at_a_time, const std::function<void(std::span<const PhotonRecord>)>& take);

 private:
  class RunReader;
  /// A run on the disk.
  struct Run {
    uint64_t begin = 0, end = 0;  ///< bytes
  };
  void sort_records();
  void keep_run();

  PhotonOrder order_;
  SortMemory memory_;
  std::vector<PhotonRecord> records_;
  std::unique_ptr<ScratchFile> file_;
  std::vector<Run> runs_;
};

}  // namespace kaustik
