#include "kaustik/light/picture_around.h"

#include "kaustik/light/equal_area.h"

namespace kaustik {

Parameter projection_parameter() {
  return choice_parameter("projection", "latlong", {"latlong", "equalarea"},
                          "How directions lie in the picture: by longitude and latitude, or in "
                          "a square of equal areas (pbrt), whose middle is +y.");
}

Image picture_around(const Arguments& arguments, PictureReader& pictures,
                     int64_t kept_bytes_per_pixel, double gamma) {
  const bool is_latlong = arguments.text("projection") == "latlong";
  // Of a square one twice as many pixels are made.
  Image image = pictures.read(
      arguments, is_latlong ? kept_bytes_per_pixel : 2 * kept_bytes_per_pixel, {.gamma = gamma});
  if (is_latlong) return image;
  if (image.width() != image.height())
    throw Error(ErrorKind::input,
                picture_name(arguments) + " is no square, as pictures of equal areas are",
                "give a square one, or 'projection' latlong", picture_place(arguments));
  return latlong_of_equal_area(image);
}

}  // namespace kaustik
