#include "screen.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <string_view>
#include <utility>

#include "environment_variable.h"
#include "signals.h"

namespace kaustik::app {
namespace {

// Control sequences of ECMA-48, and two of the VT100 that save and restore the cursor's place.
constexpr const char* clear_below = "\x1b[J";
constexpr const char* clear_line = "\x1b[K";
constexpr const char* save_cursor = "\0337";
constexpr const char* restore_cursor = "\0338";

std::string up(int rows) { return rows > 0 ? fmt::format("\x1b[{}A", rows) : std::string(); }

/// That nobody may be reading it any more is no reason to stop.
void write_out(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

int columns_by_variable() {
  const std::string text = environment_variable("COLUMNS");
  int columns = 0;
  std::from_chars(text.data(), text.data() + text.size(), columns);
  return columns > 0 && columns < 10'000 ? columns : 80;
}

std::string prefix(Level level, bool has_colours) {
  if (level == Level::plain || level == Level::error) return {};
  const char* const colour = level == Level::info ? "\x1b[32m" : "\x1b[33m\x1b[1m";
  return has_colours ? fmt::format("{}{}\x1b[m: ", colour, level_name(level))
                     : fmt::format("{}: ", level_name(level));
}

}  // namespace

const char* level_name(Level level) {
  switch (level) {
    case Level::warning:
      return "warning";
    case Level::error:
      return "error";
    default:
      return "info";
  }
}

Screen& screen() {
  static Screen only;
  return only;
}

void warn(const std::string& message) { screen().tell(Level::warning, message); }

void note(const std::string& message) { screen().tell(Level::info, message); }

Screen::Screen()
    : is_terminal_(::isatty(STDERR_FILENO) != 0),
      has_colours_(is_terminal_ && environment_variable("NO_COLOR").empty() &&
                   environment_variable("TERM") != "dumb") {}

TerminalSize Screen::size() const {
  TerminalSize result;
  winsize window{};
  if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &window) != 0 || window.ws_col == 0) {
    result.columns = columns_by_variable();
    return result;
  }
  result.columns = window.ws_col;
  if (window.ws_row > 0) result.rows = window.ws_row;
  result.width_px = window.ws_xpixel;
  result.height_px = window.ws_ypixel;
  return result;
}

void Screen::hand_messages_to(std::function<void(Level, const std::string&)> receiver) {
  const std::lock_guard lock(mutex_);
  receiver_ = std::move(receiver);
}

void Screen::tell(Level level, const std::string& text) {
  const std::lock_guard lock(mutex_);
  if (receiver_) return receiver_(level, text);
  forget_area_after_halt();
  std::string out;
  if (is_live()) out += area_cleared();
  out += prefix(level, has_colours_) + text + "\n";
  if (is_live()) out += area_drawn();
  write_out(out);
}

void Screen::show_line(const std::string& line, bool must_be_shown) {
  std::unique_lock lock(mutex_, std::defer_lock);
  if (must_be_shown)
    lock.lock();
  else if (!lock.try_lock())
    return;
  forget_area_after_halt();
  // What the line before it has left, as far as it did not go to another line when the terminal was
  // made narrower.
  const auto columns = size_t(std::max(2, size().columns) - 1);
  std::string shown = line;
  if (has_line_) shown.resize(std::max(line.size(), std::min(line_.size(), columns)), ' ');
  has_line_ = true;
  line_ = line;
  write_out("\r" + shown);
}

void Screen::show_picture(DrawnPicture picture) {
  const std::lock_guard lock(mutex_);
  forget_area_after_halt();
  const TerminalSize now = size();
  const bool fits = picture.rows == picture_.rows && now.columns == drawn_in_.columns &&
                    now.rows == drawn_in_.rows;
  std::string out;
  // In a window of another size the rows of the one before may lie anywhere: they stay.
  if (!fits) out = std::string("\r") + clear_line;
  picture_ = std::move(picture);
  drawn_in_ = now;
  write_out(out + (fits ? picture_drawn() : area_drawn()));
}

void Screen::leave() {
  const std::lock_guard lock(mutex_);
  if (is_live()) write_out("\n");
  has_line_ = false;
  line_.clear();
  picture_ = {};
}

std::string Screen::area_cleared() const {
  // The line of something that is no terminal just ends.
  if (!is_terminal_) return "\n";
  return "\r" + up(picture_.rows) + (picture_.rows > 0 ? clear_below : clear_line);
}

std::string Screen::area_drawn() const {
  std::string text(size_t(picture_.rows), '\n');
  if (picture_.rows > 0) text += picture_drawn();
  return text + line_;
}

std::string Screen::picture_drawn() const {
  return save_cursor + up(picture_.rows) + "\r" + picture_.text + restore_cursor;
}

void Screen::forget_area_after_halt() {
  if (!take_continuation()) return;
  has_line_ = false;
  picture_ = {};
}

}  // namespace kaustik::app
