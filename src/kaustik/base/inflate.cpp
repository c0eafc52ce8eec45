#include "kaustik/base/inflate.h"

#include <zlib.h>

#include <algorithm>
#include <new>

namespace kaustik {

Inflater::Inflater(std::span<const uint8_t> bytes, Packing packing)
    : Inflater(NextPiece(), packing) {
  left_ = bytes;
}

Inflater::Inflater(NextPiece next_piece, Packing packing)
    : stream_(std::make_unique<z_stream>()), next_piece_(std::move(next_piece)), packing_(packing) {
  if (inflateInit2(stream_.get(), packing == Packing::gzip ? 16 + MAX_WBITS : MAX_WBITS) != Z_OK)
    throw std::bad_alloc();
}

Inflater::~Inflater() { inflateEnd(stream_.get()); }

void Inflater::unpack(std::vector<uint8_t>& out, size_t most) {
  constexpr size_t step = 1 << 16;
  while (out.size() < most && !is_whole() && !is_damaged_) {
    const size_t before = out.size(), room = std::min(step, most - before);
    out.resize(before + room);
    out.resize(before + fill(std::span(out).subspan(before)));
  }
}

size_t Inflater::fill(std::span<uint8_t> out) {
  constexpr size_t step = size_t{1} << 30;  // zlib counts in 32 bits
  size_t filled = 0;
  while (filled < out.size() && !is_whole() && !is_damaged_) {
    const size_t room = std::min(step, out.size() - filled);
    stream_->next_out = out.data() + filled;
    stream_->avail_out = uInt(room);
    feed();
    const int result = inflate(stream_.get(), Z_NO_FLUSH);
    filled += room - stream_->avail_out;
    if (result == Z_STREAM_END) {
      at_end_ = true;
      // Another member may follow, as `cat a.gz b.gz` makes them.
      if (packing_ == Packing::gzip) inflateReset(stream_.get());
    } else if (result != Z_OK) {
      is_damaged_ = true;  // Z_BUF_ERROR: it ends too early
    }
  }
  return filled;
}

bool Inflater::is_whole() const {
  return at_end_ && (packing_ == Packing::zlib || (left_.empty() && stream_->avail_in == 0));
}

void Inflater::feed() {
  at_end_ = false;
  if (stream_->avail_in > 0) return;
  if (left_.empty() && next_piece_) {
    piece_ = next_piece_();
    left_ = piece_;
  }
  const size_t count = std::min<size_t>(left_.size(), 1u << 30);
  stream_->next_in = const_cast<Bytef*>(left_.data());
  stream_->avail_in = uInt(count);
  left_ = left_.subspan(count);
}

}  // namespace kaustik
