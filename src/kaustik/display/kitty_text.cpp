#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "kaustik/display/base64.h"
#include "kaustik/display/png_bytes.h"
#include "kaustik/display/terminal_text.h"

namespace kaustik {

std::string kitty_text(const ScreenPixels& pixels, const PicturePlace& place, uint32_t id,
                       uint32_t replaced) {
  // The longest piece that terminals have to take.
  constexpr size_t piece = 4096;
  const std::string data = base64(png_bytes(pixels));
  std::string text;
  for (size_t at = 0; at < data.size(); at += piece) {
    const bool is_last = at + piece >= data.size();
    text += "\x1b_G";
    if (at == 0)
      text += fmt::format("a=T,f=100,i={},c={},r={},C=1,q=2,", id, place.columns, place.rows);
    text += fmt::format("m={};", is_last ? 0 : 1);
    text += std::string_view(data).substr(at, piece);
    text += "\x1b\\";
  }
  if (replaced != 0) text += fmt::format("\x1b_Ga=d,d=I,i={},q=2\x1b\\", replaced);
  return text;
}

}  // namespace kaustik
