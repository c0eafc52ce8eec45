#include "kaustik/material/two_colours.h"

namespace kaustik {
namespace {

/// Of two values; one that has no share is not asked for.
template <typename Value, typename Ask0, typename Ask1>
Value shared_out(float share_of_0, const Ask0& ask_0, const Ask1& ask_1) {
  if (!(share_of_0 < 1)) return ask_0();  // also of what is no number
  if (share_of_0 <= 0) return ask_1();
  return ask_0() * share_of_0 + ask_1() * (1 - share_of_0);
}

}  // namespace

Spectrum TwoColours::eval(const TextureCoordinates& at, const Wavelengths& wavelengths) const {
  return shared_out<Spectrum>(
      share_of_color0(at.uv, at.uv_width), [&] { return color0_->eval(at, wavelengths); },
      [&] { return color1_->eval(at, wavelengths); });
}

float TwoColours::scalar(const TextureCoordinates& at) const {
  return shared_out<float>(
      share_of_color0(at.uv, at.uv_width), [&] { return color0_->scalar(at); },
      [&] { return color1_->scalar(at); });
}

HeightGradient TwoColours::height_gradient(const TextureCoordinates& at) const {
  HeightGradient result;
  const float share = share_of_color0(at.uv, at.uv_width);
  const auto add = [&](const Texture& texture, float share_of_it) {
    if (!(share_of_it > 0)) return;
    const HeightGradient own = texture.height_gradient(at);
    result.uv += own.uv * share_of_it;
    result.position += own.position * share_of_it;
  };
  add(*color0_, share);
  add(*color1_, 1 - share);
  const float rise = color0_->scalar(at) - color1_->scalar(at);
  for (int axis = 0; axis < 2; ++axis) {
    Vec2f before = at.uv, after = at.uv, extent = at.uv_width;
    extent[axis] = std::max(extent[axis], 0.005f);
    before[axis] -= 0.5f * extent[axis];
    after[axis] += 0.5f * extent[axis];
    result.uv[axis] +=
        rise * (share_of_color0(after, extent) - share_of_color0(before, extent)) / extent[axis];
  }
  return result;
}

}  // namespace kaustik
