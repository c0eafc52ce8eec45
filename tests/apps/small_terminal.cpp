#include "tests/apps/small_terminal.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>

namespace kaustik::test {
namespace {

size_t character_length(unsigned char first) {
  return first < 0x80 ? 1 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
}

}  // namespace

SmallTerminal::SmallTerminal(int columns, int rows)
    : columns_(columns), rows_(rows), window_(size_t(rows), Line(size_t(columns), " ")) {}

void SmallTerminal::send(const std::string& text) {
  for (size_t at = 0; at < text.size();) {
    const char c = text[at];
    if (c == '\r') {
      x_ = 0;
      ++at;
    } else if (c == '\n') {
      line_feed();
      ++at;
    } else if (c == '\x1b') {
      at += 1 + control(text, at + 1);
    } else {
      const size_t length = character_length(static_cast<unsigned char>(c));
      put(text.substr(at, length));
      at += length;
    }
  }
}

void SmallTerminal::put(const std::string& character) {
  if (x_ >= columns_) {
    x_ = 0;
    line_feed();
  }
  window_[size_t(y_)][size_t(x_++)] = character;
}

void SmallTerminal::line_feed() {
  if (++y_ < rows_) return;
  --y_;
  scrolled_.push_back(window_.front());
  window_.erase(window_.begin());
  window_.emplace_back(size_t(columns_), " ");
}

void SmallTerminal::clear_below() {
  std::fill(window_[size_t(y_)].begin() + std::min(x_, columns_), window_[size_t(y_)].end(), " ");
  for (int y = y_ + 1; y < rows_; ++y)
    std::fill(window_[size_t(y)].begin(), window_[size_t(y)].end(), " ");
}

size_t SmallTerminal::control(const std::string& text, size_t at) {
  if (text.compare(at, 1, "7") == 0) {
    saved_x_ = x_;
    saved_y_ = y_;
    return 1;
  }
  if (text.compare(at, 1, "8") == 0) {
    x_ = saved_x_;
    y_ = saved_y_;
    return 1;
  }
  if (text.compare(at, 1, "[") != 0) {
    unknown_.push_back(text.substr(at, 20));
    return 1;
  }
  size_t end = at + 1;
  while (end < text.size() && !std::isalpha(static_cast<unsigned char>(text[end]))) ++end;
  const std::string values = text.substr(at + 1, end - at - 1);
  const char command = end < text.size() ? text[end] : '\0';
  if (command == 'A')
    y_ = std::max(0, y_ - std::max(1, std::atoi(values.c_str())));
  else if (command == 'J' && values.empty())
    clear_below();
  else if (command == 'K' && values.empty())
    std::fill(window_[size_t(y_)].begin() + std::min(x_, columns_), window_[size_t(y_)].end(), " ");
  else if (command != 'm')
    unknown_.push_back(text.substr(at, end - at + 1));
  return end - at + 1;
}

std::vector<std::string> SmallTerminal::lines() const {
  std::vector<Line> all = scrolled_;
  all.insert(all.end(), window_.begin(), window_.end());
  std::vector<std::string> texts;
  for (const Line& line : all) {
    std::string text;
    for (const std::string& character : line) text += character;
    texts.push_back(text.substr(0, text.find_last_not_of(' ') + 1));
  }
  while (!texts.empty() && texts.back().empty()) texts.pop_back();
  return texts;
}

}  // namespace kaustik::test
