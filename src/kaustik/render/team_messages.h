#pragma once
// What the members of a team tell one another between passes.

#include <cstdint>
#include <vector>

#include "kaustik/render/session.h"

namespace kaustik {

/// What the leader wants of all members next.
struct TeamOrder {
  enum class Kind : uint8_t { render, add_up, end };
  Kind kind = Kind::end;
  SessionEnd end = SessionEnd::passes;
  PassSet passes;  ///< to be rendered
  /// By rank, how many of them each member renders: the first ones the leader, and so on.
  std::vector<uint32_t> shares;
  /// What they go by; empty: as before, or nothing is learned.
  Lessons lessons;

  std::vector<uint32_t> of_member(uint32_t rank) const;
  std::vector<uint8_t> bytes() const;
  /// Throws Error(input) if they are damaged.
  static TeamOrder from(const std::vector<uint8_t>& bytes);
};

/// What has come of a member's passes.
struct TeamReport {
  struct DonePass {
    uint32_t pass = 0;
    std::vector<uint8_t> taught;  ///< SharedLessons::take_taught()
  };
  std::vector<DonePass> passes;
  double seconds = 0;  ///< that they took together
  bool is_stopped = false;
  uint64_t rays = 0, photons = 0, dropped = 0;

  std::vector<uint8_t> bytes() const;
  /// Throws Error(input) if they are damaged.
  static TeamReport from(const std::vector<uint8_t>& bytes);
};

}  // namespace kaustik
