#include "kaustik/vcm/lessons/probe_light.h"

namespace kaustik {

Spectrum sent_to_camera(const PixelProbe& probe, const LightVertexData& photon,
                        ComponentSet wanted) {
  const Vec3f direction = photon.direction.unpack();
  Spectrum reflected;
  for (const Lobes lobe : {Lobes::diffuse, Lobes::glossy}) {
    if (!any(probe.vertex.lobes() & lobe)) continue;
    CameraPathClass whole = probe.path;
    whole.add_event(lobe);
    whole.add_event(photon.specular ? Lobes::glossy : Lobes::diffuse);
    if (wanted.has(whole.component())) reflected += probe.vertex.eval(direction, lobe);
  }
  return reflected * photon.flux.spectrum();
}

}  // namespace kaustik
