#pragma once
#include "kaustik/render/film.h"

namespace kaustik {

/// Bytes per pixel of what a render holds beside the scene and what the integrator keeps.
struct FilmMemory {
  double film = 0;    ///< the sums
  double pass = 0;    ///< the pass that is being rendered
  double splats = 0;  ///< of its light paths, beyond what the pass takes once they are in it
  double errors = 0;  ///< while they are computed: no pass is held then
  double image = 0;   ///< that is written, as floats; no pass is held then
  /// Held at the same time while passes are rendered.
  double rendering() const { return film + pass + splats; }
  /// At most at a time.
  double peak() const;
};

/// What pictures take as a rule. The film packs its sums: smooth pictures and few passes take less,
/// and sums of 256 times the passes a byte more for each number.
FilmMemory expected_film_memory(const FilmLayers& layers, bool splats);

/// Throws Error(input), at the film's place, where such a picture does not fit into this machine's
/// memory.
void check_film_memory(const FilmSettings& settings, const FilmLayers& layers, bool splats);

}  // namespace kaustik
