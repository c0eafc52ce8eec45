#include "kaustik/loader/gzip.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>

#include "kaustik/base/error.h"

namespace kaustik {
namespace {

bool is_gzip(std::span<const uint8_t> bytes) {
  return bytes.size() >= 2 && bytes[0] == 0x1f && bytes[1] == 0x8b;
}

/// A stream of zlib that ends with this.
class Inflater {
 public:
  explicit Inflater(std::span<const uint8_t> bytes) : left_(bytes) {
    constexpr int of_gzip = 16 + MAX_WBITS;
    if (inflateInit2(&stream_, of_gzip) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  /// Appends to `out` until it has `most` bytes, all is read, or something is wrong.
  void unpack(std::vector<uint8_t>& out, size_t most) {
    constexpr size_t step = 1 << 16;
    while (out.size() < most && !is_whole() && !is_damaged_) {
      const size_t before = out.size(), room = std::min(step, most - before);
      out.resize(before + room);
      stream_.next_out = &out[before];
      stream_.avail_out = uInt(room);
      feed();
      const int result = inflate(&stream_, Z_NO_FLUSH);
      out.resize(before + room - stream_.avail_out);
      if (result == Z_STREAM_END)
        end_member();
      else if (result != Z_OK)
        is_damaged_ = true;  // Z_BUF_ERROR: it ends too early
    }
  }
  /// All members have been read to their ends.
  bool is_whole() const { return at_end_ && left_.empty() && stream_.avail_in == 0; }
  bool is_damaged() const { return is_damaged_; }

 private:
  void feed() {
    at_end_ = false;
    if (stream_.avail_in > 0) return;
    const size_t count = std::min<size_t>(left_.size(), 1u << 30);
    stream_.next_in = const_cast<Bytef*>(left_.data());
    stream_.avail_in = uInt(count);
    left_ = left_.subspan(count);
  }
  /// Another may follow, as `cat a.gz b.gz` makes them.
  void end_member() {
    at_end_ = true;
    inflateReset(&stream_);
  }

  z_stream stream_{};
  std::span<const uint8_t> left_;
  bool at_end_ = false, is_damaged_ = false;
};

}  // namespace

std::vector<uint8_t> unpacked(std::vector<uint8_t> bytes, size_t most, const Place& where) {
  if (!is_gzip(bytes)) return bytes;
  const size_t usual = always_allowed_growth + usual_growth * bytes.size();
  std::vector<uint8_t> out;
  Inflater inflater(bytes);
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
  Inflater(bytes).unpack(out, most);
  return out;
}

}  // namespace kaustik
