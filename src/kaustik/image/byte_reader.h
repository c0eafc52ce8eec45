#pragma once
#include "kaustik/image/formats.h"

namespace kaustik::formats {

/// Little-endian numbers at places in a file; throws BadImage beyond its end.
class ByteReader {
 public:
  explicit ByteReader(ByteView file) : file_(file) {}

  size_t size() const { return file_.size(); }
  uint8_t u8(size_t at) const { return bytes(at, 1)[0]; }
  uint16_t u16(size_t at) const { return uint16_t(number(at, 2)); }
  uint32_t u32(size_t at) const { return number(at, 4); }
  int32_t i32(size_t at) const { return int32_t(number(at, 4)); }
  ByteView bytes(size_t at, size_t count) const {
    if (at > file_.size() || count > file_.size() - at) throw BadImage("the file is truncated");
    return file_.subspan(at, count);
  }

 private:
  uint32_t number(size_t at, size_t count) const {
    const ByteView b = bytes(at, count);
    uint32_t value = 0;
    for (size_t i = 0; i < count; ++i) value |= uint32_t(b[i]) << (8 * i);
    return value;
  }

  ByteView file_;
};

}  // namespace kaustik::formats
