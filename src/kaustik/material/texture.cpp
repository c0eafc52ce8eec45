#include "kaustik/material/texture.h"

#include "kaustik/base/sampler.h"
#include "kaustik/image/photometry.h"

namespace kaustik {

float luminance_of(const Spectrum& rgb) { return photopic({rgb[0], rgb[1], rgb[2]}); }

float Texture::scalar(const TextureCoordinates& at) const { return luminance_of(eval(at, {})); }

Spectrum sampled_mean(const Texture& texture, float extent, int count) {
  Spectrum sum;
  for (int i = 0; i < count; ++i) {
    Sampler sampler(0x6d65616e, uint32_t(i));
    const Vec2f u = sampler.next_2d(), v = sampler.next_2d();
    TextureCoordinates at;
    at.uv = u * extent;
    at.position = Vec3f(u.x - 0.5f, u.y - 0.5f, v.x - 0.5f) * extent;
    at.normal = {0, 0, 1};
    sum += texture.eval(at, {});
  }
  return sum / float(count);
}

}  // namespace kaustik
