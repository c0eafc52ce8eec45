#pragma once
#include <optional>

#include "kaustik/base/statistics.h"
#include "kaustik/base/vec.h"
#include "kaustik/render/film_errors.h"
#include "kaustik/view/json_text.h"

namespace kaustik {
class Watched;
class Film;
}  // namespace kaustik

namespace kaustik::view {

/// What a film knows of one of its pixels, and of the mean luminance of some of them (FilmErrors);
/// the pixels must lie in it.
Json pixel_facts(const Film& film, int x, int y);
Json region_facts(const Film& film, const PixelRegion& region);

/// The same of what is shown; of a picture before its first pass the values alone. Throw
/// RequestError for pixels that it has not, or while there is no picture.
Json pixel_of(const Watched& shown, int x, int y);
Json region_of(const Watched& shown, const PixelRegion& region);

}  // namespace kaustik::view
