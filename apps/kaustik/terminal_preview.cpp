#include "terminal_preview.h"

#include <unistd.h>

#include <utility>

#include "kaustik/display/screen_pixels.h"
#include "kaustik/display/terminal_text.h"
#include "screen.h"

namespace kaustik::app {
namespace {

/// Half blocks are a few kilobytes, pictures of other kinds up to a megabyte.
std::chrono::milliseconds pause_of(TerminalGraphics graphics) {
  return std::chrono::milliseconds(graphics == TerminalGraphics::blocks ? 300 : 1000);
}

}  // namespace

TerminalPreview::TerminalPreview(TerminalKind kind, std::shared_ptr<const ToneOperator> tone)
    : kind_(kind),
      tone_(std::move(tone)),
      next_(std::chrono::steady_clock::now()),
      // Numbers are shared by all programs of a terminal.
      first_id_((uint32_t(::getpid()) << 1) + 2) {}

bool TerminalPreview::is_ready() const { return std::chrono::steady_clock::now() >= next_; }

void TerminalPreview::show(const Image& image) {
  const TerminalSize window = screen().size();
  // Below it is the line of progress, and above it one that tells where it begins.
  const int most_rows = window.rows - 2;
  if (most_rows < 1 || window.columns < 2) return;
  const PicturePlace place =
      picture_place({image.width(), image.height()}, window, kind_.graphics, most_rows);
  const ScreenPixels pixels = screen_pixels(image, *tone_, place.pixels);
  screen().show_picture({drawn(pixels, place), place.rows});
  next_ = std::chrono::steady_clock::now() + pause_of(kind_.graphics);
}

std::string TerminalPreview::drawn(const ScreenPixels& pixels, const PicturePlace& place) {
  switch (kind_.graphics) {
    case TerminalGraphics::kitty: {
      const uint32_t turn = shown_++;
      return kitty_text(pixels, place, first_id_ + turn % 2,
                        turn == 0 ? 0 : first_id_ + (turn + 1) % 2);
    }
    case TerminalGraphics::iterm:
      return iterm_text(pixels, place);
    case TerminalGraphics::sixel:
      return sixel_text(pixels);
    case TerminalGraphics::blocks:
      break;
  }
  return blocks_text(pixels, kind_.full_colour);
}

}  // namespace kaustik::app
