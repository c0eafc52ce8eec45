#pragma once
#include <array>
#include <vector>

#include "kaustik/render/film.h"

namespace kaustik {

/// Degrees of freedom of the variance of a sum whose parts by replicate have variances in
/// proportion to these shares s of it, with their own mean taken off (Satterthwaite 1946):
/// (R − 1)/R (Σ a)²/Σ a², a = s (1 − s/Σ s), of the R shares that are not 0. With equal ones R − 1.
double freedom_of_shares(const std::array<double, replicate_count>& shares);

/// How many passes a pixel has, by replicate, and what sums by replicate tell with so many.
class PassCounts {
 public:
  PassCounts() = default;
  explicit PassCounts(const PassSet& passes) { add(passes, false); }
  /// Those of a region that the pixel lies in, beside.
  void add_regional(const PassSet& passes) { add(passes, true); }

  uint32_t count() const { return count_; }
  uint32_t of_replicate(size_t replicate) const { return of_replicate_[replicate]; }
  /// Of even replicates or of odd ones, bias_halves.
  uint32_t of_half(uint32_t half) const;
  /// That have passes.
  int replicates() const { return replicates_; }
  /// Whether noise is known: there are two replicates.
  bool is_known() const { return replicates_ >= 2; }
  /// Of the variance of a mean: one less than replicates, or fewer where some replicates have far
  /// more passes than others: freedom_of_shares(). Only if noise is known.
  double freedom() const;
  /// What Σ (S_r − n_r m)²/n² is multiplied by to be the variance of the mean m of n passes. As
  /// long as replicates have equally many passes it is R/(R − 1). Only if noise is known.
  double scale() const;
  /// Of the mean of all passes, by their sums by replicate. Only if noise is known.
  double variance(const std::array<double, replicate_count>& sums) const;
  friend bool operator==(const PassCounts&, const PassCounts&) = default;

 private:
  void add(const PassSet& passes, bool is_regional);

  std::array<uint32_t, replicate_count> of_replicate_{};
  uint32_t count_ = 0;
  int replicates_ = 0;
  bool is_uneven_ = false;  ///< replicates may differ by more than a pass
};

/// The parts of a film's picture whose pixels have the same passes: one if it has no regions.
class FilmParts {
 public:
  explicit FilmParts(const Film& film);

  size_t count() const { return counts_.size(); }
  size_t part_of(size_t pixel) const { return parts_.empty() ? 0 : parts_[pixel]; }
  const PassCounts& operator[](size_t part) const { return counts_[part]; }
  const PassCounts& of_pixel(size_t pixel) const { return counts_[part_of(pixel)]; }
  /// Of all parts that have pixels: regions may leave the first one none.
  bool are_known() const;

 private:
  std::vector<PassCounts> counts_;   ///< the first: of passes of all of the picture alone
  std::vector<uint32_t> parts_;      ///< by pixel; empty: all are of the first
  std::vector<uint8_t> has_pixels_;  ///< by part
};

}  // namespace kaustik
