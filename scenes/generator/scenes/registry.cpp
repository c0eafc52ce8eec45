#include "scenes/scenes.h"

namespace kaustik::scenes {

std::span<const SceneMaker> scene_makers() {
  static const std::vector<SceneMaker> makers = {
      {"point_spotlight", "A spotlight on a red folding screen in a pale room.",
       make_point_spotlight},
      {"museum", "A museum's hall with lamps on its exhibits, in the evening sun.", make_museum},
      {"gallery_1", "A gallery of pictures lit through lampshades.", make_gallery_1},
      {"gallery_2", "A long gallery with two rows of lampshades.", make_gallery_2},
      {"maze", "A random maze at dusk with lamps in its ways.", make_maze},
      {"pool_above", "An indoor swimming pool.", make_pool_above},
      {"pool_below", "The pool from under its water.", make_pool_below},
      {"atrium", "A domed hall with a chandelier above a fountain.", make_atrium},
      {"still_life", "Glass, metal, water and fruit on a table in the late sun.", make_still_life},
  };
  return makers;
}

}  // namespace kaustik::scenes
