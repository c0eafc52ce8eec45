#pragma once
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "kaustik/base/vec.h"

namespace kaustik {

/// Picks points that keep their distance from one another, so that what is computed at one of them
/// is hardly of use to the others: greedily, in the order in which they are offered.
class SpacedSubset {
 public:
  /// Whether `position` lies at least `spacing` > 0 from all points picked so far with about the
  /// same spacing and direction of `normal`; if so it is picked too.
  bool pick(const Vec3f& position, const Vec3f& normal, float spacing);

 private:
  struct Entry {
    Vec3f position;
    uint32_t next;
  };
  static constexpr uint32_t none = 0xffffffffu;

  std::unordered_map<uint64_t, uint32_t> first_in_cell_;
  std::vector<Entry> picked_;
};

}  // namespace kaustik
