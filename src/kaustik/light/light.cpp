#include "kaustik/light/light.h"

#include "kaustik/light/light_kinds.h"

namespace kaustik {

const std::vector<LightType>& light_types() {
  static const std::vector<LightType> types = {area_light_type(),
                                               directional_area_light_type(),
                                               point_light_type(),
                                               spot_light_type(),
                                               projector_light_type(),
                                               goniometric_light_type(),
                                               directional_light_type(),
                                               constant_light_type(),
                                               envmap_light_type(),
                                               sunsky_light_type(),
                                               sky_light_type(),
                                               sun_light_type(),
                                               background_light_type(),
                                               distributed_light_type(),
                                               distributed_spot_light_type()};
  return types;
}

}  // namespace kaustik
