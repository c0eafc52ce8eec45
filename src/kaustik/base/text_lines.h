#pragma once
#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
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
/// Without blanks and ends of lines at its own ends.
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
  bool next_slowly(std::string_view& line);
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

/// The first '\n' or '\r'; `last` where there is none.
inline const char* find_line_end(const char* first, const char* last) {
  using Letters = signed char __attribute__((vector_size(16)));
  for (; last - first >= 16; first += 16) {
    Letters letters;
    std::memcpy(&letters, first, sizeof(letters));
    const Letters found = (letters == '\n') | (letters == '\r');
    uint64_t halves[2];
    std::memcpy(halves, &found, sizeof(found));
    if (halves[0] != 0) return first + std::countr_zero(halves[0]) / 8;
    if (halves[1] != 0) return first + 8 + std::countr_zero(halves[1]) / 8;
  }
  return std::find_if(first, last, [](char c) { return c == '\n' || c == '\r'; });
}

inline bool TextLines::next(std::string_view& line) {
  number_ += parts_;
  parts_ = 0;
  if (at_end() || position() >= end_) return false;
  // Mostly all of the line is there, with what follows its end, and it does not go on.
  const char* const first = buffer_.data() + begin_;
  const char* const last = buffer_.data() + buffer_.size();
  const char* const stop = find_line_end(first, last);
  if (last - stop < 2 || (stop != first && stop[-1] == '\\')) [[unlikely]]
    return next_slowly(line);
  parts_ = 1;
  line = std::string_view(first, size_t(stop - first));
  begin_ += line.size() + (stop[0] == '\r' && stop[1] == '\n' ? 2 : 1);
  return true;
}

}  // namespace kaustik
