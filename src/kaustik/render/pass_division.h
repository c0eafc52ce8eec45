#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "kaustik/render/pass_set.h"

namespace kaustik {

/// One of several parts of a picture's passes.
struct PassPart {
  static constexpr uint32_t maximum_count = 1'000'000;
  uint32_t index = 0;  ///< from 0 on
  uint32_t count = 1;
  friend bool operator==(const PassPart&, const PassPart&) = default;
};

/// The passes of a picture, divided into parts: blocks, in order, as equal as whole passes can be.
/// Of one division no two parts have a pass in common, and together they have all.
struct PassDivision {
  PassRange whole;
  uint32_t parts = 0;  ///< 0: not divided; else at most so many as there are passes
  bool is_divided() const { return parts > 0; }
  /// Of part `index`, from 0 on.
  PassRange part(uint32_t index) const;
  friend bool operator==(const PassDivision&, const PassDivision&) = default;
};

/// Parts of a division, by their numbers from 1 on, of which passes are missing.
struct MissingParts {
  std::vector<uint32_t> absent;      ///< all passes are missing
  std::vector<uint32_t> unfinished;  ///< some are
  bool empty() const { return absent.empty() && unfinished.empty(); }
  /// "parts 3, 7–9 of 64 are missing; part 5 of 64 is unfinished", for people; "": none is.
  std::string text(uint32_t parts) const;
};
MissingParts missing_parts(const PassDivision& division, const PassSet& there);

}  // namespace kaustik
