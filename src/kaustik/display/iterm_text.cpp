#include <fmt/format.h>

#include "kaustik/display/base64.h"
#include "kaustik/display/png_bytes.h"
#include "kaustik/display/terminal_text.h"

namespace kaustik {

std::string iterm_text(const ScreenPixels& pixels, const PicturePlace& place) {
  const std::vector<uint8_t> png = png_bytes(pixels);
  return fmt::format(
      "\x1b]1337;File=size={};width={};height={};preserveAspectRatio=1;inline=1:{}\x07", png.size(),
      place.columns, place.rows, base64(png));
}

}  // namespace kaustik
