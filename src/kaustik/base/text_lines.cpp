#include "kaustik/base/text_lines.h"

#include <algorithm>

#include "kaustik/base/error.h"

namespace kaustik {
namespace {

constexpr size_t most_at_once = size_t{1} << 20;
/// Of the line that goes on behind the end of a part.
constexpr size_t step_behind_end = size_t{1} << 14;

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
  const auto is_white = [](char c) { return is_blank(c) || c == '\n'; };
  while (!text.empty() && is_white(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_white(text.back())) text.remove_suffix(1);
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

TextLines::TextLines(const std::string& path)
    : own_(std::make_unique<InputFile>(path)),
      file_(*own_),
      read_(0),
      size_(file_.size()),
      end_(size_) {
  skip_to(0);
}

TextLines::TextLines(const InputFile& file, uint64_t begin, uint64_t end)
    // What ends before a line tells whether it goes on: a backslash and two letters.
    : file_(file), read_(begin - std::min<uint64_t>(begin, 3)), size_(file.size()), end_(end) {
  skip_to(begin);
}

/// Goes to the first line that begins there or behind, within the part.
void TextLines::skip_to(uint64_t begin) {
  const auto skipped = size_t(begin - read_);
  do refill();
  while (begin > 0 && read_ < std::min(end_, size_));
  if (begin == 0) {
    const auto* bytes = reinterpret_cast<const uint8_t*>(buffer_.data());
    begin_ = length_of_byte_order_mark({bytes, buffer_.size()}, file_.path());
    return;
  }
  const char* const first = buffer_.data();
  const char* const last = first + buffer_.size();
  for (bool goes_on = true; goes_on && first + begin_ != last;) {
    const char* const stop = find_line_end(first + begin_, last);
    goes_on = stop != first && stop[-1] == '\\';
    begin_ = size_t(
        std::min(stop + (last - stop > 1 && stop[0] == '\r' && stop[1] == '\n' ? 2 : 1), last) -
        first);
    goes_on |= begin_ < skipped;
  }
}

/// False: the file has no more.
bool TextLines::refill() {
  buffer_.erase(buffer_.begin(), buffer_.begin() + std::ptrdiff_t(begin_));
  begin_ = 0;
  const size_t before = buffer_.size();
  const uint64_t most =
      read_ < end_ ? std::min<uint64_t>(most_at_once, end_ - read_) : uint64_t{step_behind_end};
  const auto wanted = size_t(std::min(most, size_ - read_));
  buffer_.resize(before + wanted);
  const size_t count =
      file_.read(read_, {reinterpret_cast<uint8_t*>(buffer_.data()) + before, wanted});
  buffer_.resize(before + count);
  read_ += count;
  if (count < wanted) size_ = read_;  // it has become shorter meanwhile
  return count > 0;
}

/// Up to the end of the line.
std::string_view TextLines::next_part() {
  ++parts_;
  size_t length = 0;
  for (;;) {
    const char* const last = buffer_.data() + buffer_.size();
    length =
        size_t(find_line_end(buffer_.data() + begin_ + length, last) - buffer_.data()) - begin_;
    // After a '\r' the next letter tells whether the end has two.
    const size_t needed = begin_ + length + 1;
    const bool is_clear =
        needed < buffer_.size() || (needed == buffer_.size() && buffer_[begin_ + length] == '\n');
    if (is_clear || !refill()) break;
  }
  const std::string_view rest(buffer_.data() + begin_, buffer_.size() - begin_);
  const size_t end = rest.substr(length, 2) == "\r\n" ? 2 : 1;
  begin_ += std::min(length + end, rest.size());
  return rest.substr(0, length);
}

bool TextLines::next_slowly(std::string_view& line) {
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
