#include "kaustik/vcm/lessons/probe_light.h"

namespace kaustik {

ProbeLight::ProbeLight(const PixelProbe& probe, ComponentSet wanted)
    : probe_(probe), wanted_(wanted), is_matt_(probe.vertex.is_matt()) {
  if (!is_matt_) return;
  for (const bool specular : {false, true})
    if (is_wanted(Lobes::diffuse, specular)) matt_[specular] = probe.vertex.diffuse_value();
}

bool ProbeLight::is_wanted(Lobes lobe, bool specular) const {
  CameraPathClass whole = probe_.path;
  whole.add_event(lobe);
  whole.add_event(specular ? Lobes::glossy : Lobes::diffuse);
  return wanted_.has(whole.component());
}

Spectrum ProbeLight::value_of(const Vec3f& direction, const LightVertexData& photon) const {
  Spectrum value;
  for (const Lobes lobe : {Lobes::diffuse, Lobes::glossy})
    if (any(probe_.vertex.lobes() & lobe) && is_wanted(lobe, photon.specular))
      value += probe_.vertex.eval(direction, lobe);
  return value;
}

}  // namespace kaustik
