#pragma once
#include <string>
#include <vector>

namespace kaustik::thesis {

/// A table in Markdown; the first column is aligned left, the others right.
class MarkdownTable {
 public:
  explicit MarkdownTable(std::vector<std::string> header) : width_(header.size()) {
    add(header);
    std::string rule = "|";
    for (size_t i = 0; i < width_; ++i) rule += i == 0 ? "---|" : "---:|";
    text_ += rule + "\n";
  }
  void add(const std::vector<std::string>& cells) {
    text_ += "|";
    for (size_t i = 0; i < width_; ++i) text_ += " " + (i < cells.size() ? cells[i] : "") + " |";
    text_ += "\n";
  }
  const std::string& text() const { return text_; }

 private:
  size_t width_;
  std::string text_;
};

}  // namespace kaustik::thesis
