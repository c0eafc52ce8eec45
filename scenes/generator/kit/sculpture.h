#pragma once
// Works of art for museums; each stands on z = 0 about the origin. Metres.

#include "kit/field.h"
#include "kit/primitives.h"

namespace kaustik::scenes {

/// A dancer in a long skirt, one arm raised, 1.9 m tall, facing -y; made of blended bodies on a
/// grid of edge `cell`.
Mesh dancer(double cell);
/// A trefoil knot of a thick rope, standing upright.
Mesh knot(double height);
/// The shell of a sea snail, a growing tube wound up.
Mesh snail_shell(double size);
/// Crystals that grow from one root.
Mesh crystal_cluster(double height, int count, uint64_t seed);
/// A head like those of the Cyclades: a plane face and a long nose.
Mesh idol_head(double height, double cell);

}  // namespace kaustik::scenes
