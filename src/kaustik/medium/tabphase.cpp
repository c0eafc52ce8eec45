#include <fmt/format.h>

#include <algorithm>

#include "kaustik/base/number_list.h"
#include "kaustik/medium/medium_kinds.h"

namespace kaustik {
namespace {

class TabPhase final : public PhaseFunction {
 public:
  explicit TabPhase(const std::vector<double>& values) {
    // Of large and small ones alike the sums are numbers.
    const double largest = *std::max_element(values.begin(), values.end());
    const double width = 2 / double(values.size() - 1);
    double sum = 0, cosine_sum = 0;
    std::vector<double> sums = {0};
    for (size_t i = 0; i + 1 < values.size(); ++i) {
      const double a = values[i] / largest, b = values[i + 1] / largest;
      const double from = -1 + width * double(i), to = from + width;
      sum += width * (a + b) / 2;
      cosine_sum += width * (a * (2 * from + to) + b * (from + 2 * to)) / 6;
      sums.push_back(sum);
    }
    mean_cosine_ = float(cosine_sum / sum);
    for (const double value : values) densities_.push_back(float(value / largest / sum));
    for (const double value : sums) cumulative_.push_back(float(value / sum));
  }

  float eval(const Vec3f& wo, const Vec3f& wi) const override {
    const float at = (1 - dot(wo, wi)) / 2 * float(densities_.size() - 1);
    const size_t i = size_t(std::clamp(int(at), 0, int(densities_.size()) - 2));
    const float share = std::clamp(at - float(i), 0.0f, 1.0f);
    return (densities_[i] + (densities_[i + 1] - densities_[i]) * share) * (0.5f * inv_pi);
  }

  Vec3f sample(const Vec3f& wo, const Vec2f& u) const override {
    const float cosine = sample_cosine(u.x);
    const float sine = safe_sqrt(1 - cosine * cosine);
    const float phi = 2 * pi * u.y;
    return Frame(-wo).to_world({sine * std::cos(phi), sine * std::sin(phi), cosine});
  }

  float mean_cosine() const override { return mean_cosine_; }

 private:
  float sample_cosine(float u) const {
    // The last entry that is not above u and has something behind it.
    const auto above = std::upper_bound(cumulative_.begin() + 1, cumulative_.end() - 1, u);
    const auto i = size_t(above - cumulative_.begin()) - 1;
    const float mass = cumulative_[i + 1] - cumulative_[i];
    const float share = mass > 0 ? std::clamp((u - cumulative_[i]) / mass, 0.0f, 1.0f) : 0.5f;
    // Where between the two the integral of a + (b − a) x comes to that share of it.
    const float a = densities_[i], b = densities_[i + 1];
    const float root = std::sqrt(a * a + share * (b * b - a * a));
    const float x = a + root > 0 ? std::min(share * (a + b) / (a + root), 1.0f) : share;
    return std::clamp(-1 + 2 * (float(i) + x) / float(densities_.size() - 1), -1.0f, 1.0f);
  }

  std::vector<float> densities_;   ///< of the cosine, integral 1
  std::vector<float> cumulative_;  ///< from 0 to 1
  float mean_cosine_ = 0;
};

const TypeInfo& tabphase_info() {
  static const TypeInfo info{
      "phase",
      "tabphase",
      "A phase function given by values. They need not be normalised.",
      {required(text_parameter("values", "",
                               "Values at equally spaced cosines of the scattering angle, from -1 "
                               "(backward) to 1 (forward), separated by commas."))}};
  return info;
}

std::vector<double> parse_values(const std::string& text, const Place& place) {
  constexpr size_t most = 1 << 20;
  auto [values, wrong_word] = parse_number_list(text);
  const auto wrong =
      std::find_if(values.begin(), values.end(), [](double value) { return value < 0; });
  if (!wrong_word.empty() || wrong != values.end() || values.size() > most)
    throw Error(ErrorKind::input,
                fmt::format("value {} of phase 'tabphase' is no number from zero on",
                            std::min(size_t(wrong - values.begin()), most) + 1),
                fmt::format("give 2 to {} finite numbers, none of them negative", most), place);
  if (values.size() < 2 || *std::max_element(values.begin(), values.end()) == 0)
    throw Error(ErrorKind::input,
                fmt::format("phase 'tabphase' has {} values{}", values.size(),
                            values.size() < 2 ? "" : ", all of them zero"),
                "give at least two, one of them above zero", place);
  return values;
}

}  // namespace

std::shared_ptr<const PhaseFunction> tabulated_phase_function(const std::vector<double>& values) {
  return std::make_shared<TabPhase>(values);
}

PhaseFunctionType tabphase_type() {
  return {tabphase_info(), [](const PhaseFunctionInputs& inputs) {
            return tabulated_phase_function(
                parse_values(inputs.arguments.text("values"), inputs.arguments.place_of("values")));
          }};
}

}  // namespace kaustik
