#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace kaustik {

/// Passes from `begin` to before `end`.
struct PassRange {
  uint32_t begin = 0, end = 0;
  friend bool operator==(const PassRange&, const PassRange&) = default;
};

/// Passes have smaller numbers than this, so that counting on from one stays in range.
inline constexpr uint32_t pass_limit = uint32_t(1) << 31;

/// A set of pass numbers, kept as ranges that neither overlap nor touch, in ascending order.
class PassSet {
 public:
  /// The range may be empty.
  void add(PassRange range);
  void add(const PassSet& other);

  uint32_t count() const { return count_; }
  /// Those with this remainder of the division by `modulus`.
  uint32_t count_of_remainder(uint32_t remainder, uint32_t modulus) const;
  bool empty() const { return ranges_.empty(); }
  const std::vector<PassRange>& ranges() const { return ranges_; }
  bool holds(uint32_t pass) const { return first_missing(pass) != pass; }
  /// The first pass from `from` on that is not there.
  uint32_t first_missing(uint32_t from) const;
  PassSet common(const PassSet& other) const;
  /// How many passes of a range are not there.
  uint32_t missing(PassRange range) const;
  /// "0–3, 7", for people; "none" where it is empty.
  std::string text() const;

 private:
  /// A range behind all others.
  void append(PassRange range);

  std::vector<PassRange> ranges_;
  uint32_t count_ = 0;
};

}  // namespace kaustik
