#include "kaustik/material/bsdf_kinds.h"

namespace kaustik {
namespace {

/// Not there as far as light is concerned: a boundary of media of the same index.
class Null final : public Bsdf {
 public:
  Null() : Bsdf({.transmits = true, .is_null = true}) {}
  Spectrum eval(const BsdfContext&, const Vec3f&, const Vec3f&, Lobes) const override { return {}; }
  float pdf(const BsdfContext&, const Vec3f&, const Vec3f&, Lobes) const override { return 0; }
  BsdfSample sample(const BsdfContext&, const Vec3f&, float, const Vec2f&, Lobes) const override {
    return {};
  }
  Spectrum albedo(const BsdfContext&, const Vec3f&, Lobes) const override { return {}; }
};

const TypeInfo& null_info() {
  static const TypeInfo info{"bsdf",
                             "null",
                             "Lets light pass as if there were no surface. It is for the boundary "
                             "of a medium without refraction.",
                             {}};
  return info;
}

std::shared_ptr<const Bsdf> create_null(const BsdfInputs&) { return std::make_shared<Null>(); }

}  // namespace

BsdfType null_type() { return {null_info(), 0, 0, create_null}; }

}  // namespace kaustik
