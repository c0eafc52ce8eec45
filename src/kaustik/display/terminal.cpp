#include "kaustik/display/terminal.h"

#include <algorithm>
#include <cmath>

namespace kaustik {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Of a character, in pixels.
struct CellSize {
  double width, height;
};

CellSize cell_size(const TerminalSize& terminal, TerminalGraphics graphics) {
  if (terminal.width_px > 0 && terminal.height_px > 0)
    return {double(terminal.width_px) / std::max(1, terminal.columns),
            double(terminal.height_px) / std::max(1, terminal.rows)};
  // Sixels are sent without a number of rows: rather too small than over the window's edge.
  if (graphics == TerminalGraphics::sixel) return {6, 12};
  return {10, 20};
}

}  // namespace

const std::vector<std::string>& terminal_graphics_names() {
  static const std::vector<std::string> names{"kitty", "iterm", "sixel", "blocks"};
  return names;
}

std::optional<TerminalKind> terminal_kind(
    const std::function<std::string(const std::string&)>& variable) {
  const std::string term = variable("TERM"), program = variable("TERM_PROGRAM"),
                    colours = variable("COLORTERM");
  if (term.empty() || term == "dumb") return std::nullopt;
  const bool is_told_full = colours == "truecolor" || colours == "24bit" || has(term, "direct");
  // Variables of the terminal around them get into both.
  if (!variable("TMUX").empty() || term.starts_with("tmux"))
    return TerminalKind{TerminalGraphics::blocks, true};
  if (!variable("STY").empty() || term.starts_with("screen"))
    return TerminalKind{TerminalGraphics::blocks, false};
  if (!variable("KITTY_WINDOW_ID").empty() || has(term, "kitty") || has(term, "ghostty"))
    return TerminalKind{TerminalGraphics::kitty, true};
  if (program == "iTerm.app" || program == "WezTerm" || program == "mintty")
    return TerminalKind{TerminalGraphics::iterm, true};
  if (has(term, "sixel") || term.starts_with("foot") || term.starts_with("mlterm") ||
      term.starts_with("yaft") || term.starts_with("contour"))
    return TerminalKind{TerminalGraphics::sixel, true};
  return TerminalKind{TerminalGraphics::blocks, is_told_full};
}

PicturePlace picture_place(Vec2i size, const TerminalSize& terminal, TerminalGraphics graphics,
                           int most_rows) {
  constexpr double most_pixels = 600'000;
  const bool in_blocks = graphics == TerminalGraphics::blocks;
  const CellSize cell = cell_size(terminal, graphics);
  // The last column stays free: some terminals go to the next line there.
  const int columns = std::max(1, terminal.columns - 1), rows = std::max(1, most_rows);
  // What is shown has pixels of its own: half blocks, or the window's.
  const double width = in_blocks ? cell.width : 1, height = in_blocks ? cell.height / 2 : 1;
  const double largest = in_blocks
                             ? std::min(width, height)
                             : std::min(1.0, std::sqrt(most_pixels / (double(size.x) * size.y)));
  const double scale =
      std::min({largest, columns * cell.width / size.x, rows * cell.height / size.y});
  const auto pixels = [](double extent, double most) {
    return int(std::clamp(std::round(extent), 1.0, std::max(1.0, std::floor(most + 1e-6))));
  };
  PicturePlace place;
  place.pixels = {pixels(size.x * scale / width, columns * cell.width / width),
                  pixels(size.y * scale / height, rows * cell.height / height)};
  const auto cells = [](double extent, double of, int most) {
    return std::clamp(int(std::ceil(extent / of - 1e-6)), 1, most);
  };
  place.columns = cells(place.pixels.x * width, cell.width, columns);
  place.rows = cells(place.pixels.y * height, cell.height, rows);
  return place;
}

}  // namespace kaustik
