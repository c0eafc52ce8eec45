#pragma once
// What an eye does to a picture before tone mapping: glare, loss of acuity and of colour in the
// dark. Ward Larson, Rushmeier and Piatko 1997, section 5. Each function is one model.

#include "kaustik/image/picture.h"

namespace kaustik {

/// The light that scatters inside the eye when it looks at each cell of `foveal` (section 5.1,
/// after Moon and Spencer 1945): 0.087 times the mean of all other cells, weighted by cos θ / θ²,
/// with θ the angle between the directions. Over 12 000 cells are first joined into fewer. One
/// cell: no veil.
Grid<Vec3f> veil(const Grid<Vec3f>& foveal, const Picture& picture);

/// Replaces `picture` by 0.913 times itself plus the veil, interpolated between its cells.
void add_veil(Picture& picture, const Grid<Vec3f>& veil);

/// Blurs each place so that nothing finer is left than the eye can resolve when it is adapted to
/// what `foveal` has there (section 5.3): an image pyramid (Williams 1983), interpolated to
/// the pixel size whose Nyquist frequency is visual_acuity().
void blur_to_acuity(Picture& picture, const Grid<Vec3f>& foveal);

}  // namespace kaustik
