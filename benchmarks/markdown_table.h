#pragma once
#include <string>
#include <vector>

namespace kaustik::bench {

/// A table in Markdown; the first column is aligned left, the others right.
class MarkdownTable {
 public:
  explicit MarkdownTable(std::vector<std::string> header) : width_(header.size()) {
    add(header);
    std::string rule = "|";
    for (size_t i = 0; i < width_; ++i) rule += i == 0 ? "---|" : "---:|";
    text_ += rule + "\n";
  }
  void add(const std::vector<std::string>& cells) { add_row(row(cells)); }
  /// A row by itself, to be kept for later …
  std::string row(const std::vector<std::string>& cells) const {
    std::string text = "|";
    for (size_t i = 0; i < width_; ++i) text += " " + (i < cells.size() ? cells[i] : "") + " |";
    return text + "\n";
  }
  /// … and added then.
  void add_row(const std::string& row) { text_ += row; }
  const std::string& text() const { return text_; }

 private:
  size_t width_;
  std::string text_;
};

}  // namespace kaustik::bench
