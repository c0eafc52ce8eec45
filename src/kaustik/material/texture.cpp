#include "kaustik/material/texture.h"

#include "kaustik/image/photometry.h"

namespace kaustik {

float luminance_of(const Spectrum& rgb) { return photopic({rgb[0], rgb[1], rgb[2]}); }

float Texture::scalar(const TextureCoordinates& at) const { return luminance_of(eval(at, {})); }

}  // namespace kaustik
