#include "kaustik/base/warp.h"
#include "kaustik/medium/medium_kinds.h"

namespace kaustik {
namespace {

class HenyeyGreenstein final : public PhaseFunction {
 public:
  explicit HenyeyGreenstein(float g) : g_(g) {}

  float eval(const Vec3f& wo, const Vec3f& wi) const override {
    // 1 + g² − 2g cosθ as a sum of two terms that are never negative.
    const float magnitude = std::fabs(g_);
    const float cosine = std::copysign(1.0f, g_) * -dot(wo, wi);
    const float base = sqr(1 - magnitude) + 2 * magnitude * std::max(0.0f, 1 - cosine);
    return sphere_pdf * (1 - g_ * g_) / (base * std::sqrt(base));
  }

  Vec3f sample(const Vec3f& wo, const Vec2f& u) const override {
    const float cos_theta = sample_cosine(u.x);
    const float sin_theta = safe_sqrt(1 - cos_theta * cos_theta);
    const float phi = 2 * pi * u.y;
    return Frame(-wo).to_world({sin_theta * std::cos(phi), sin_theta * std::sin(phi), cos_theta});
  }

  float mean_cosine() const override { return g_; }

 private:
  /// Inverse of the distribution of cosθ.
  float sample_cosine(float u) const {
    if (std::fabs(g_) < 1e-3f) {
      // To second order in g, where the closed form divides by it.
      const float x = 2 * u - 1;
      return std::clamp(x + 1.5f * g_ * (1 - x * x) - 2.0f * g_ * g_ * x * (1 - x * x), -1.0f,
                        1.0f);
    }
    const float ratio = (1 - g_ * g_) / (1 - g_ + 2 * g_ * u);
    return std::clamp((1 + g_ * g_ - ratio * ratio) / (2 * g_), -1.0f, 1.0f);
  }

  float g_;
};

const TypeInfo& henyey_greenstein_info() {
  static const TypeInfo info{
      "phase",
      "hg",
      "Henyey and Greenstein's phase function: forward or backward scattering.",
      {number_parameter("g", 0.8,
                        "Mean cosine of the scattering angle, between -1 and 1. Positive values "
                        "scatter forward.")
           .range(-1, 1)}};
  return info;
}

std::shared_ptr<const PhaseFunction> create_henyey_greenstein(const PhaseFunctionInputs& inputs) {
  const Arguments& arguments = inputs.arguments;
  const auto g = float(arguments.number("g"));
  if (!(std::fabs(g) < 1))
    throw Error(ErrorKind::input, "g of phase 'hg' is -1 or 1, which scatters nowhere but straight",
                "keep it between the two, such as 0.95", arguments.place_of("g"));
  return henyey_greenstein_phase_function(g);
}

}  // namespace

std::shared_ptr<const PhaseFunction> henyey_greenstein_phase_function(float g) {
  return std::make_shared<HenyeyGreenstein>(g);
}

PhaseFunctionType henyey_greenstein_type() {
  return {henyey_greenstein_info(), create_henyey_greenstein};
}

}  // namespace kaustik
