#pragma once
#include "kaustik/material/bsdf.h"

namespace kaustik {

/// What a bsdf says of itself, see Bsdf.
struct BsdfTraits {
  Lobes lobes = Lobes::none;
  bool transmits = false, is_null = false;
  SurfaceNeeds needs = SurfaceNeeds::none;
  int size = 0;
};

inline BsdfTraits traits_of(const Bsdf& bsdf) {
  return {bsdf.lobes(), bsdf.transmits(), bsdf.is_null(), bsdf.needs(), bsdf.size()};
}

/// A bsdf made of nested ones. Knows its traits from the start: asking the nested ones anew would
/// take twice as long for each level of bsdfs that are used twice.
class CompoundBsdf : public Bsdf {
 public:
  explicit CompoundBsdf(const BsdfTraits& traits) : traits_(traits) {}
  Lobes lobes() const final { return traits_.lobes; }
  bool transmits() const final { return traits_.transmits; }
  bool is_null() const final { return traits_.is_null; }
  SurfaceNeeds needs() const final { return traits_.needs; }
  int size() const final { return traits_.size; }

 private:
  BsdfTraits traits_;
};

}  // namespace kaustik
