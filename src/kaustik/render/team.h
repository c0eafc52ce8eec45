#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "kaustik/base/exact_sum.h"

namespace kaustik {

/// Processes that render one picture together, each with the same program, scene and settings. The
/// member of rank 0 leads. All members make the same calls in the same order, and each call waits
/// for the others as far as it needs them. A member that ends without having made them all takes
/// the others with it.
class Team {
 public:
  virtual ~Team() = default;
  virtual uint32_t rank() const = 0;
  virtual uint32_t size() const = 0;
  bool is_led_here() const { return rank() == 0; }

  /// The leader's bytes, for all of them. What others give is not looked at.
  virtual std::vector<uint8_t> from_leader(std::vector<uint8_t> bytes) = 0;
  /// All members' bytes, by rank, for the leader. Others get nothing.
  virtual std::vector<std::vector<uint8_t>> to_leader(std::vector<uint8_t> bytes) = 0;
  /// Adds up equally many sums of all members as add_to() does; the leader gets the result. What
  /// the others hold then is of no use.
  virtual void add_up(std::span<Fixed> sums) = 0;
};

}  // namespace kaustik
