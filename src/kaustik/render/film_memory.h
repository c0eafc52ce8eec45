#pragma once
#include "kaustik/render/film.h"

namespace kaustik {

/// Bytes per pixel of what a render holds beside the scene and what the integrator keeps.
struct FilmMemory {
  double film = 0;    ///< the sums
  double pass = 0;    ///< the pass that is being rendered, and what adding it takes
  double splats = 0;  ///< of its light paths; of all tiles beside the pass where that may be cut
  double errors = 0;  ///< while they are computed: no pass is held then
  double image = 0;   ///< that is written, as floats; no pass is held then
  /// Held at the same time while passes are rendered.
  double rendering() const { return film + pass + splats; }
  /// At most at a time.
  double peak() const;
};

/// What pictures take at most, by the bits that each number needs: for 1024 passes, and as far as
/// the numbers of a tile do not spread wider than film_memory.cpp foresees. Smooth pictures, few
/// passes and components that are not there take less; 256 times the passes take a byte more for
/// each number.
FilmMemory expected_film_memory(const FilmLayers& layers, bool splats);

/// Throws Error(input), at the film's place, where such a picture does not fit into this machine's
/// memory.
void check_film_memory(const FilmSettings& settings, const FilmLayers& layers, bool splats);

/// Throws Error(input) where these regions, with passes of their own, do not fit beside it.
void check_region_memory(const FilmSettings& settings, const FilmLayers& layers, bool splats,
                         const std::vector<PixelRegion>& regions);

}  // namespace kaustik
