#include "kaustik/base/gzip.h"

#include <fmt/format.h>

#include <algorithm>

#include "kaustik/base/error.h"
#include "kaustik/base/inflate.h"

namespace kaustik {

bool is_gzip(std::span<const uint8_t> bytes) {
  return bytes.size() >= 2 && bytes[0] == 0x1f && bytes[1] == 0x8b;
}

std::vector<uint8_t> unpacked(std::vector<uint8_t> bytes, size_t most, const Place& where) {
  if (!is_gzip(bytes)) return bytes;
  const size_t usual = always_allowed_growth + usual_growth * bytes.size();
  std::vector<uint8_t> out;
  Inflater inflater(bytes, Packing::gzip);
  inflater.unpack(out, std::min(most, usual) + 1);
  if (inflater.is_damaged())
    throw Error(ErrorKind::input, "the gzip'd file is damaged or ends too early",
                "copy or pack it again", where);
  if (out.size() > usual && usual < most)
    throw Error(
        ErrorKind::input,
        fmt::format("the gzip'd file of {} bytes grows to more than {} bytes", bytes.size(), usual),
        "unpack it if that is meant", where);
  return out;
}

std::vector<uint8_t> unpacked_start(std::span<const uint8_t> bytes, size_t most) {
  if (!is_gzip(bytes))
    return {bytes.begin(), bytes.begin() + std::ptrdiff_t(std::min(most, bytes.size()))};
  std::vector<uint8_t> out;
  Inflater(bytes, Packing::gzip).unpack(out, most);
  return out;
}

}  // namespace kaustik
