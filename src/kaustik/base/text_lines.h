#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "kaustik/base/file.h"
#include "kaustik/base/memory.h"

namespace kaustik {

/// How many bytes of `bytes`, the first of a file, are a mark that it is UTF-8 text. Throws
/// Error(input) naming `file` where the mark of another encoding stands.
size_t length_of_byte_order_mark(std::span<const uint8_t> bytes, const std::string& file);

/// Between words of a line.
inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
/// Without blanks at its ends.
std::string_view trimmed(std::string_view text);
/// Takes the first word off a line; "" where there is none.
std::string_view next_word(std::string_view& line);

/// The lines of a text file, read piece by piece. Any system may have written their ends. Throws
/// Error(input) as read_file() does, and for text in UTF-16.
class TextLines {
 public:
  explicit TextLines(const std::string& path);
  /// The lines that begin in a part of a file, from byte `begin` to before byte `end`: those of all
  /// parts together are those of the file, if the first one is longer than three bytes. `file` must
  /// outlive this.
  TextLines(const InputFile& file, uint64_t begin, uint64_t end);

  /// False: there is none left. A line that ends with a backslash goes on in the next one; it is
  /// valid until the next call.
  bool next(std::string_view& line);
  /// The number in the file, or among the lines of the part, from 1, at which the line begins;
  /// behind the last one, that of what would follow.
  int number() const { return number_; }
  /// Of the file, where what is not handed out yet begins.
  uint64_t position() const { return read_ - (buffer_.size() - begin_); }
  uint64_t file_size() const { return file_.size(); }

 private:
  void skip_to(uint64_t begin);
  std::string_view next_part();
  bool refill();
  bool at_end() const { return begin_ == buffer_.size() && read_ == size_; }

  std::unique_ptr<const InputFile> own_;  ///< may be null
  const InputFile& file_;
  uint64_t read_, size_;  ///< of the file: what is in the buffer, and all
  uint64_t end_;          ///< where no lines begin any more
  UnsetVector<char> buffer_;
  size_t begin_ = 0;    ///< of what is not handed out yet
  std::string joined_;  ///< the line, where it goes on
  int number_ = 1, parts_ = 0;
};

}  // namespace kaustik
