#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "kaustik/base/vec.h"

namespace kaustik {

/// How a terminal shows pictures.
enum class TerminalGraphics : uint8_t {
  kitty,  ///< kitty's graphics protocol, https://sw.kovidgoyal.net/kitty/graphics-protocol/
  iterm,  ///< inline images of iTerm2, https://iterm2.com/documentation-images.html
  sixel,  ///< sixel graphics of DEC's VT340 (EK-VT3XX-TP, chapter 14), with 252 colours
  blocks  ///< half blocks: two pixels in each character, one above the other
};
/// In the order of the enumeration: "kitty", "iterm" …
const std::vector<std::string>& terminal_graphics_names();

/// A terminal's window.
struct TerminalSize {
  int columns = 80, rows = 24;
  int width_px = 0, height_px = 0;  ///< 0: not known
};

/// What is known of a terminal.
struct TerminalKind {
  TerminalGraphics graphics = TerminalGraphics::blocks;
  bool full_colour = true;  ///< 24 bits for characters; else the 256 colours of xterm
};

/// What a terminal says of itself in its variables TERM, TERM_PROGRAM, COLORTERM, KITTY_WINDOW_ID,
/// TMUX and STY. `variable` gives a variable's value, "" if there is none. Within tmux and screen
/// half blocks are all that gets through. None: it cannot move its cursor.
std::optional<TerminalKind> terminal_kind(
    const std::function<std::string(const std::string&)>& variable);

/// The place that a picture takes in a terminal.
struct PicturePlace {
  int columns = 0, rows = 0;  ///< characters
  Vec2i pixels{0, 0};         ///< to be shown there: ScreenPixels of this size
};

/// For a picture of `size` pixels, with its proportions, in at most so many rows and all columns
/// but the last. Pixels are never shown larger than they are; pictures of half blocks have at most
/// one pixel for each of theirs, others 600 000.
PicturePlace picture_place(Vec2i size, const TerminalSize& terminal, TerminalGraphics graphics,
                           int most_rows);

}  // namespace kaustik
