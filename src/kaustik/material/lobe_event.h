#pragma once
#include "kaustik/material/bsdf.h"

namespace kaustik {

/// The sample of a direction that some lobe has proposed: the event is drawn by `u`, uniform in
/// [0, 1), by the shares of the lobes in f. Absorbed if f or the density is zero.
inline BsdfSample sample_with_event(const Vec3f& wi, const Spectrum& diffuse,
                                    const Spectrum& glossy, float pdf, bool transmission, float u) {
  BsdfSample sample;
  const float diffuse_sum = diffuse.sum(), sum = diffuse_sum + glossy.sum();
  if (!(pdf > 0) || !(sum > 0)) return sample;
  const float diffuse_share = diffuse_sum / sum;
  const bool is_diffuse = u < diffuse_share;
  sample.wi = wi;
  sample.pdf_solid_angle = pdf;
  sample.event = is_diffuse ? Lobes::diffuse : Lobes::glossy;
  sample.transmission = transmission;
  const float cosine = std::fabs(wi.z);
  sample.weight = is_diffuse ? diffuse * (cosine / (pdf * diffuse_share))
                             : glossy * (cosine / (pdf * (1 - diffuse_share)));
  return sample;
}

}  // namespace kaustik
