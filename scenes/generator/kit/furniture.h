#pragma once
// Things that stand in rooms; each stands on z = 0 about the origin. Metres.

#include "kit/field.h"
#include "kit/surface.h"
#include "kit/sweep.h"

namespace kaustik::scenes {

/// Bentwood chair whose back is toward +y.
struct BentwoodChair {
  Mesh wood, cane;  ///< frame, and the seat's wickerwork
};
BentwoodChair bentwood_chair();

/// A plant with long drooping leaves in a pot.
struct PottedPlant {
  Mesh pot, earth, stems, leaves;
};
PottedPlant potted_plant(double height, int leaves, uint64_t seed);

/// Folding screen of panels hinged edge to edge that stand at `fold_degrees` to the line of the
/// screen, alternately; the middle of the line is the origin, its front faces -y.
struct FoldingScreen {
  Mesh frame, cloth, hinges;
};
FoldingScreen folding_screen(int panels, double panel_width, double height, double fold_degrees);

/// A bench with an upholstered seat along x.
struct Bench {
  Mesh seat, legs;
};
Bench bench(double length, double depth, double height);

/// Pedestal with a plinth and a cap.
Mesh pedestal(double width, double height);

/// Vases: profiles turned on the wheel, with a wall and an opening.
Mesh amphora(double height);
Mesh bowl(double radius);

/// Gilded outline for `frame`: a picture frame's moulding, `width` wide and `depth` deep.
Curve frame_outline(double width, double depth);

}  // namespace kaustik::scenes
