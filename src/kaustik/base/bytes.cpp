#include "kaustik/base/bytes.h"

#include "kaustik/base/error.h"

namespace kaustik {

void ByteWriter::put_bytes(const void* data, size_t size) {
  const auto* begin = static_cast<const uint8_t*>(data);
  if (size > 0) bytes_.insert(bytes_.end(), begin, begin + size);
}

void ByteWriter::put_text(const std::string& text) {
  put(uint64_t(text.size()));
  put_bytes(text.data(), text.size());
}

std::span<const uint8_t> ByteReader::get_bytes(uint64_t count) {
  if (count > rest_.size()) damaged("it ends too early");
  const std::span<const uint8_t> result = rest_.first(count);
  rest_ = rest_.subspan(count);
  return result;
}

std::string ByteReader::get_text() {
  const auto count = get<uint64_t>();
  const std::span<const uint8_t> bytes = get_bytes(count);
  return {bytes.begin(), bytes.end()};
}

bool ByteReader::get_flag() {
  const auto value = get<uint8_t>();
  if (value > 1) damaged("a yes or no in it is neither");
  return value == 1;
}

void ByteReader::expect_end() const {
  if (!rest_.empty()) damaged("it goes on behind its end");
}

void ByteReader::damaged(const std::string& why) const {
  throw Error(ErrorKind::input, what_ + " is damaged: " + why);
}

}  // namespace kaustik
