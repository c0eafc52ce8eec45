#pragma once
#include "kaustik/scene/description.h"

namespace kaustik::bench {

/// The scene with materials and lamps that every renderer has, so that each gets the same room:
/// glossy coats go and their matt base stays, textures become the mean of their colours, rough
/// metal becomes matt, thin sheets let nothing through, all matt surfaces are alike on both sides,
/// and each placement of a group becomes shapes of its own. Only lamps that are surfaces stay.
/// Throws Error(input) for materials, textures and groups that it does not know.
Description plain_room(const Description& description);

}  // namespace kaustik::bench
