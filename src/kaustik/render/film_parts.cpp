#include "kaustik/render/film_parts.h"

#include <algorithm>
#include <limits>

namespace kaustik {

void PassCounts::add(const PassSet& passes, bool is_regional) {
  for (uint32_t r = 0; r < replicate_count; ++r) {
    const uint32_t more = passes.count_of_remainder(r, replicate_count);
    if (of_replicate_[r] == 0 && more > 0) ++replicates_;
    of_replicate_[r] += more;
    count_ += more;
  }
  is_uneven_ = is_uneven_ || is_regional;
}

uint32_t PassCounts::of_half(uint32_t half) const {
  uint32_t count = 0;
  for (uint32_t r = half; r < replicate_count; r += bias_halves) count += of_replicate_[r];
  return count;
}

double freedom_of_shares(const std::array<double, replicate_count>& shares) {
  double total = 0, sum = 0, squares = 0;
  int replicates = 0;
  for (const double share : shares) {
    total += share;
    replicates += share > 0 ? 1 : 0;
  }
  for (const double share : shares) {
    const double mean = share * (1 - share / total);
    sum += mean;
    squares += sqr(mean);
  }
  return sqr(sum) / squares * (replicates - 1) / replicates;
}

double PassCounts::freedom() const {
  if (!is_uneven_) return replicates_ - 1;
  std::array<double, replicate_count> shares;
  std::copy(of_replicate_.begin(), of_replicate_.end(), shares.begin());
  return freedom_of_shares(shares);
}

double PassCounts::scale() const {
  if (!is_uneven_) return double(replicates_) / (replicates_ - 1);
  double squares = 0;
  for (const uint32_t n : of_replicate_) squares += sqr(double(n) / count_);
  return 1 / (1 - squares);
}

double PassCounts::variance(const std::array<double, replicate_count>& sums) const {
  double total = 0;
  for (const double sum : sums) total += sum;
  const double n = count_, mean = total / n;
  double squares = 0;
  for (size_t r = 0; r < replicate_count; ++r) squares += sqr(sums[r] - of_replicate_[r] * mean);
  if (is_uneven_) return squares / sqr(n) * scale();
  return squares / sqr(n) * replicates_ / (replicates_ - 1);
}

FilmParts::FilmParts(const Film& film) : counts_{PassCounts(film.passes())}, has_pixels_{1} {
  if (film.regions().empty()) return;
  parts_.resize(film.pixel_count());
  for (const FilmRegion& region : film.regions()) {
    // Each part that the region meets is cut in two.
    constexpr uint32_t none = std::numeric_limits<uint32_t>::max();
    std::vector<uint32_t> within(counts_.size(), none);
    const PixelRegion& in = region.pixels;
    for (int y = in.y; y < in.y + in.height; ++y)
      for (int x = in.x; x < in.x + in.width; ++x) {
        uint32_t& part = parts_[size_t(y) * size_t(film.width()) + size_t(x)];
        if (within[part] == none) {
          within[part] = uint32_t(counts_.size());
          counts_.push_back(counts_[part]);
          counts_.back().add_regional(region.film.passes());
        }
        part = within[part];
      }
  }
  has_pixels_.assign(counts_.size(), 0);
  for (const uint32_t part : parts_) has_pixels_[part] = 1;
}

bool FilmParts::are_known() const {
  for (size_t part = 0; part < counts_.size(); ++part)
    if (has_pixels_[part] != 0 && !counts_[part].is_known()) return false;
  return true;
}

}  // namespace kaustik
