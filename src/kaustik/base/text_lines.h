#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "kaustik/base/file.h"

namespace kaustik {

/// How many bytes of `bytes`, the first of a file, are a mark that it is UTF-8 text. Throws
/// Error(input) naming `file` where the mark of another encoding stands.
size_t length_of_byte_order_mark(std::span<const uint8_t> bytes, const std::string& file);

/// Without blanks at its ends.
std::string_view trimmed(std::string_view text);
/// Takes the first word off a line; "" where there is none.
std::string_view next_word(std::string_view& line);

/// The lines of a text file, read piece by piece. Any system may have written their ends. Throws
/// Error(input) as read_file() does, and for text in UTF-16.
class TextLines {
 public:
  explicit TextLines(const std::string& path);

  /// False: there is none left. A line that ends with a backslash goes on in the next one; it is
  /// valid until the next call.
  bool next(std::string_view& line);
  /// The number in the file, from 1, at which the line begins.
  int number() const { return number_; }
  uint64_t file_size() const { return file_.size(); }

 private:
  std::string_view next_part();
  bool refill();
  bool at_end() const { return begin_ == buffer_.size() && read_ == end_; }

  InputFile file_;
  uint64_t read_ = 0, end_;
  std::string buffer_;
  size_t begin_ = 0;    ///< of what is not handed out yet
  std::string joined_;  ///< the line, where it goes on
  int number_ = 1, parts_ = 0;
};

}  // namespace kaustik
