// Compiled once per instruction set, of which Highway chooses at run time.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kaustik/light/choice_weights.cpp"
#include <hwy/foreach_target.h>
// Highway asks for this order.
#include <hwy/highway.h>

#include "kaustik/light/choice_weights.h"

HWY_BEFORE_NAMESPACE();
namespace kaustik::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

void Raise(float* values, size_t padded_count, float least, float& sum, float& total) {
  const hn::CappedTag<float, EmissionBalls::padding> d;
  const auto zero = hn::Zero(d), largest = hn::Set(d, 1e30f);
  auto best = zero, before = zero, after = zero;
  for (size_t i = 0; i < padded_count; i += hn::Lanes(d)) {
    const auto value = hn::Min(hn::LoadU(d, values + i), largest);
    best = hn::Max(best, value);
    before = hn::Add(before, value);
  }
  const auto floor = hn::Mul(hn::MaxOfLanes(d, best), hn::Set(d, least));
  for (size_t i = 0; i < padded_count; i += hn::Lanes(d)) {
    const auto value = hn::Min(hn::LoadU(d, values + i), largest);
    const auto raised = hn::IfThenElseZero(hn::Gt(value, zero), hn::Max(value, floor));
    hn::StoreU(raised, d, values + i);
    after = hn::Add(after, raised);
  }
  sum = hn::GetLane(hn::SumOfLanes(d, before));
  total = hn::GetLane(hn::SumOfLanes(d, after));
}

}  // namespace
}  // namespace kaustik::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kaustik {
namespace {
HWY_EXPORT(Raise);
}  // namespace

void ChoiceWeights::raise(size_t count, float least) {
  HWY_DYNAMIC_DISPATCH(Raise)
  (values_.data(), EmissionBalls::padded(count), least, sum_, total_);
}

void ChoiceWeights::replace(size_t count, const float* values) {
  std::copy_n(values, EmissionBalls::padded(count), values_.data());
  raise(count, 0);
  sum_ = 0;
}

}  // namespace kaustik
#endif
