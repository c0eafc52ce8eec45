#pragma once
#include <array>
#include <cstdint>

#include "kaustik/base/wavelengths.h"

namespace kaustik {

/// The wavelengths of a pass. In RGB mode there is one set, red, green and blue. In spectral mode
/// there are up to four sets of four, and all of them together have equidistant quantiles: with
/// sixteen grey is grey from the first pass on, with four there is a tint for dozens of passes.
/// Light of a set meets light of the same set alone; the picture is the mean over the sets.
class WavelengthSets {
 public:
  static constexpr size_t most = 4;

  /// One set: RGB, unless another is asked for.
  WavelengthSets(const Wavelengths& only = {})  // NOLINT(google-explicit-constructor)
      : sets_{only, only, only, only} {}
  /// `count` sets, 1 to `most`, of pass number `pass` of a seed. Passes stratify one another.
  static WavelengthSets of_pass(uint64_t seed, uint32_t pass, size_t count = most);
  /// Those that another pass has where this one has these: of_pass(), or the same if they were
  /// given.
  WavelengthSets of_other_pass(uint64_t seed, uint32_t pass) const {
    return are_given_ ? *this : of_pass(seed, pass, count_);
  }

  bool is_rgb() const { return sets_[0].is_rgb(); }
  size_t count() const { return count_; }
  const Wavelengths& operator[](size_t set) const { return sets_[set]; }
  /// The set of sample number `sample` of a pixel, where `first` is evenly random and independent
  /// of the pass's wavelengths: then pixels with fewer samples than sets, or with any other number,
  /// see all sets alike in the mean. Of four sets two samples in succession, from an even sum of
  /// both numbers on, have eight equidistant quantiles.
  size_t of_sample(uint32_t first, uint32_t sample) const {
    const size_t index = first % count_ + sample;
    constexpr std::array<uint8_t, most> order = {0, 2, 1, 3};
    return count_ == most ? order[index % most] : index % count_;
  }
  /// Factors on red, green and blue by which the mean over four sets shows white light as white.
  /// They bias other colours by the square of what sixteen wavelengths are off, some 1e-5. Of fewer
  /// sets that would be much: then they are 1.
  const Spectrum& balance() const { return balance_; }

  friend bool operator==(const WavelengthSets& a, const WavelengthSets& b) {
    return a.count_ == b.count_ && a.sets_ == b.sets_;
  }

 private:
  std::array<Wavelengths, most> sets_;
  size_t count_ = 1;
  bool are_given_ = true;
  Spectrum balance_ = Spectrum(1);
};

}  // namespace kaustik
