#include <fmt/format.h>

#include <algorithm>

#include "kaustik/base/mixture_weights.h"
#include "kaustik/material/blend.h"
#include "kaustik/material/bsdf_kinds.h"
#include "kaustik/material/mask.h"

namespace kaustik {
namespace {

constexpr int most_mixed = 64;

/// Scatters nothing.
class Black final : public Bsdf {
 public:
  Black() : Bsdf({}) {}
  Spectrum eval(const BsdfContext&, const Vec3f&, const Vec3f&, Lobes) const override {
    return Spectrum();
  }
  float pdf(const BsdfContext&, const Vec3f&, const Vec3f&, Lobes) const override { return 0; }
  BsdfSample sample(const BsdfContext&, const Vec3f&, float, const Vec2f&, Lobes) const override {
    return {};
  }
  Spectrum albedo(const BsdfContext&, const Vec3f&, Lobes) const override { return Spectrum(); }
};

/// Throws Error(input) for weights that are wrong.
std::vector<double> weights_of(const BsdfInputs& inputs) {
  MixtureWeights weights =
      mixture_weights(inputs.arguments.text("weights"), inputs.nested.size(), "nested bsdfs");
  if (!weights.problem.empty())
    throw Error(ErrorKind::input, weights.problem, weights.remedy,
                inputs.arguments.place_of("weights"));
  return std::move(weights.numbers);
}

const TypeInfo& mixturebsdf_info() {
  static const TypeInfo info{
      "bsdf",
      "mixturebsdf",
      "Mixes any number of nested bsdfs. If the weights sum to less than 1, the rest is absorbed.",
      {text_parameter("weights", "1", "One weight for each nested bsdf, separated by commas."),
       ignored_parameter("ensure_energy_conservation", ParameterKind::boolean)}};
  return info;
}

/// A chain of blends, from the last one backward.
std::shared_ptr<const Bsdf> create_mixturebsdf(const BsdfInputs& inputs) {
  const std::vector<double> weights = weights_of(inputs);
  double sum = 0;
  for (const double weight : weights) sum += weight;
  refuse_reliefs_in_blend(inputs);
  // As in Mitsuba 0.6; rounded thirds are no reason to speak.
  if (sum > 1 + 1e-4)
    inputs.warn(
        fmt::format("the weights of bsdf 'mixturebsdf' add up to {:.4g}: they are divided "
                    "by that",
                    sum));
  const double whole = std::max(sum, 1.0);
  // What is mixed so far, with the share of the whole that it stands for.
  std::shared_ptr<const Bsdf> mixed = std::make_shared<Black>();
  double share = 1 - sum / whole;
  if (share < 1e-6) share = 0;
  for (size_t i = weights.size(); i-- > 0;) {
    const double weight = weights[i] / whole;
    if (weight == 0) continue;
    if (share > 0) {
      const auto rest = make_constant_texture(SpectralValue(float(share / (share + weight))));
      mixed = make_blend(with_lobe(inputs.nested[i]), mixed, rest);
    } else {
      mixed = with_lobe(inputs.nested[i]);
    }
    share += weight;
  }
  return mixed;
}

}  // namespace

BsdfType mixturebsdf_type() { return {mixturebsdf_info(), 1, most_mixed, create_mixturebsdf}; }

}  // namespace kaustik
