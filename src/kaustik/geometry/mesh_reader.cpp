#include "kaustik/geometry/mesh_reader.h"

#include <fmt/format.h>

#include <algorithm>

namespace kaustik {

size_t byte_order_mark(std::span<const uint8_t> bytes, const std::string& file) {
  const auto begins_with = [&](std::initializer_list<uint8_t> mark) {
    return bytes.size() >= mark.size() && std::equal(mark.begin(), mark.end(), bytes.begin());
  };
  if (begins_with({0xff, 0xfe}) || begins_with({0xfe, 0xff}))
    throw Error(ErrorKind::input, "the mesh is written in UTF-16",
                "save it as UTF-8 or plain ASCII", place_in(file, 1, 1));
  return begins_with({0xef, 0xbb, 0xbf}) ? 3 : 0;
}

std::string remark_on_small_faces(size_t count, const std::string& file) {
  return fmt::format("{}: {} {} left out: fewer than three corners", file, count,
                     count == 1 ? "face was" : "faces were");
}

}  // namespace kaustik
