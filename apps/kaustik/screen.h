#pragma once
#include <fmt/format.h>

#include <functional>
#include <mutex>
#include <string>

#include "kaustik/display/terminal.h"

namespace kaustik::app {

/// What a message is.
enum class Level { plain, info, warning, error };
const char* level_name(Level level);

/// A picture as text for the terminal, which stays within so many rows: terminal_text.h.
struct DrawnPicture {
  std::string text;
  int rows = 0;
};

/// Standard error: messages, which stay; on a terminal below them what is kept up to date, a
/// picture and under it a line. All that the program says goes through here, from any thread.
class Screen {
 public:
  Screen();
  bool is_terminal() const { return is_terminal_; }
  /// Of the window, as it is now.
  TerminalSize size() const;

  /// Lines of text, the last without its end. Nobody need be reading them.
  void tell(Level level, const std::string& text);
  /// From now on messages go there in place of standard error; empty: no more.
  void hand_messages_to(std::function<void(Level, const std::string&)> receiver);

  /// Keeps the line up to date; it has no more characters than the window has columns. If it need
  /// not be shown, it is not where that would have to wait for another thread.
  void show_line(const std::string& line, bool must_be_shown);
  void show_picture(DrawnPicture picture);
  /// Leaves what was kept up to date as it is; what comes next comes below.
  void leave();

 private:
  bool is_live() const { return has_line_ || picture_.rows > 0; }
  std::string area_cleared() const;
  std::string area_drawn() const;
  std::string picture_drawn() const;
  void forget_area_after_halt();

  const bool is_terminal_, has_colours_;
  std::mutex mutex_;  ///< of what follows, and of writing
  std::function<void(Level, const std::string&)> receiver_;
  bool has_line_ = false;
  std::string line_;
  DrawnPicture picture_;
  TerminalSize drawn_in_;  ///< the picture
};

/// The program's only one.
Screen& screen();

/// A line on standard error.
template <typename... Values>
void say(fmt::format_string<Values...> text, Values&&... values) {
  screen().tell(Level::plain, fmt::format(text, std::forward<Values>(values)...));
}
/// What is odd, or went wrong by half.
void warn(const std::string& message);
/// What the user may want to know.
void note(const std::string& message);

}  // namespace kaustik::app
