#pragma once
// Views of Radiance as cameras (rpict.1, vwrays.1 of Radiance).

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "kaustik/loader/deviations.h"
#include "kaustik/loader/radiance/objects.h"

namespace kaustik::radiance {

/// What the options of a view say.
struct View {
  std::string name;
  char type = 'v';  ///< v perspective, l parallel, h hemispherical, a angular, s planisphere,
                    ///< c cylinder
  Vec3d point{0, 0, 0}, direction{0, 1, 0}, up{0, 0, 1};
  double horizontal = 45, vertical = 45;  ///< whole angles in degrees, sizes of parallel views
  double shift = 0, lift = 0;             ///< as shares of the view
  double fore = 0, aft = 0;               ///< clipping distances, 0: none
  Place place;
};

/// The options of a picture beside its view.
struct PictureOptions {
  int width = 512, height = 512;  ///< at most
  double exposure_stops = 0;
  double lens_diameter = 0;  ///< 0: a pinhole
};

/// Reads options such as "-vp 0 0 1"; what comes before them and options of programs are passed
/// over. Files (-vf) are read by `read`. Throws Error(input) for what is wrong.
View read_view(std::string_view text, const Place& place,
               const std::function<std::string(const std::string& file)>& read);

/// The first view in the text of a view file, or in the header of a picture; nothing if there is
/// none.
std::optional<std::string> view_line_of(std::string_view text);

/// The camera, with its film.
ObjectPointer camera_of(const View& view, const PictureOptions& options, Deviations& deviations);

}  // namespace kaustik::radiance
