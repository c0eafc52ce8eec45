#include "kaustik/vcm/lessons/probe_light.h"

namespace kaustik {

ProbeLight::ProbeLight(const PixelProbe& probe, ComponentSet wanted, const Wavelengths& wavelengths)
    : vertex_(probe.vertex.in(wavelengths)),
      path_(probe.path),
      wanted_(wanted),
      lane_sum_scale_(kaustik::lane_sum_scale(wavelengths)),
      is_matt_(vertex_.is_matt()) {
  if (!is_matt_) return;
  for (const bool specular : {false, true})
    if (is_wanted(Lobes::diffuse, specular)) matt_[specular] = vertex_.diffuse_value();
}

bool ProbeLight::is_wanted(Lobes lobe, bool specular) const {
  CameraPathClass whole = path_;
  whole.add_event(lobe);
  whole.add_event(specular ? Lobes::glossy : Lobes::diffuse);
  return wanted_.has(whole.component());
}

Spectrum ProbeLight::value_of(const Vec3f& direction, const LightVertexData& photon) const {
  Spectrum value;
  for (const Lobes lobe : {Lobes::diffuse, Lobes::glossy})
    if (any(vertex_.lobes() & lobe) && is_wanted(lobe, photon.specular))
      value += vertex_.eval(direction, lobe);
  return value;
}

}  // namespace kaustik
