#include "kaustik/base/text_lines.h"

#include <algorithm>

#include "kaustik/base/error.h"

namespace kaustik {
namespace {

constexpr size_t piece_bytes = size_t{1} << 20;

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

}  // namespace

size_t length_of_byte_order_mark(std::span<const uint8_t> bytes, const std::string& file) {
  const auto begins_with = [&](std::initializer_list<uint8_t> mark) {
    return bytes.size() >= mark.size() && std::equal(mark.begin(), mark.end(), bytes.begin());
  };
  if (begins_with({0xff, 0xfe}) || begins_with({0xfe, 0xff}))
    throw Error(ErrorKind::input, "the file is written in UTF-16",
                "save it as UTF-8 or plain ASCII", place_in(file, 1, 1));
  return begins_with({0xef, 0xbb, 0xbf}) ? 3 : 0;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view next_word(std::string_view& line) {
  size_t begin = 0;
  while (begin < line.size() && is_blank(line[begin])) ++begin;
  size_t end = begin;
  while (end < line.size() && !is_blank(line[end])) ++end;
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

TextLines::TextLines(const std::string& path) : file_(path), end_(file_.size()) {
  refill();
  const auto* bytes = reinterpret_cast<const uint8_t*>(buffer_.data());
  begin_ = length_of_byte_order_mark({bytes, buffer_.size()}, path);
}

/// False: the file has no more.
bool TextLines::refill() {
  buffer_.erase(0, begin_);
  begin_ = 0;
  const size_t before = buffer_.size();
  const auto wanted = size_t(std::min<uint64_t>(piece_bytes, end_ - read_));
  buffer_.resize(before + wanted);
  const size_t count =
      file_.read(read_, {reinterpret_cast<uint8_t*>(buffer_.data()) + before, wanted});
  buffer_.resize(before + count);
  read_ += count;
  if (count < wanted) end_ = read_;  // it has become shorter meanwhile
  return count > 0;
}

/// Up to the end of the line.
std::string_view TextLines::next_part() {
  ++parts_;
  size_t length = 0;
  for (;;) {
    while (begin_ + length < buffer_.size() && buffer_[begin_ + length] != '\n' &&
           buffer_[begin_ + length] != '\r')
      ++length;
    // After a '\r' the next letter tells whether the end has two.
    const size_t needed = begin_ + length + 1;
    const bool is_clear =
        needed < buffer_.size() || (needed == buffer_.size() && buffer_[begin_ + length] == '\n');
    if (is_clear || !refill()) break;
  }
  const std::string_view rest = std::string_view(buffer_).substr(begin_);
  const size_t end = rest.substr(length, 2) == "\r\n" ? 2 : 1;
  begin_ += std::min(length + end, rest.size());
  return rest.substr(0, length);
}

bool TextLines::next(std::string_view& line) {
  number_ += parts_;
  parts_ = 0;
  if (at_end()) return false;
  line = next_part();
  if (!line.ends_with('\\')) return true;
  joined_.clear();
  while (line.ends_with('\\')) {
    joined_.append(line.substr(0, line.size() - 1));
    joined_.push_back(' ');
    line = at_end() ? std::string_view() : next_part();
  }
  joined_.append(line);
  line = joined_;
  return true;
}

}  // namespace kaustik
