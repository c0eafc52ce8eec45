#pragma once
// What a terminal shows after a text was sent to it: as much of a VT100 as the program uses.

#include <string>
#include <vector>

namespace kaustik::test {

class SmallTerminal {
 public:
  SmallTerminal(int columns, int rows);
  void send(const std::string& text);

  /// All lines from the first that scrolled out of the window to the last of the window, without
  /// blanks at their ends.
  std::vector<std::string> lines() const;
  /// Control sequences that it does not know, and pictures of terminals that show some.
  const std::vector<std::string>& unknown() const { return unknown_; }

 private:
  using Line = std::vector<std::string>;  ///< characters of UTF-8

  void put(const std::string& character);
  void line_feed();
  /// The sequence that begins behind ESC; returns its length.
  size_t control(const std::string& text, size_t at);
  void clear_below();

  const int columns_, rows_;
  std::vector<Line> scrolled_, window_;
  int x_ = 0, y_ = 0, saved_x_ = 0, saved_y_ = 0;
  std::vector<std::string> unknown_;
};

}  // namespace kaustik::test
