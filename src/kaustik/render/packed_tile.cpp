#include "kaustik/render/packed_tile.h"

#include <algorithm>
#include <cassert>

namespace kaustik {

const uint8_t* PackedTile::content_of(size_t line, size_t lines) const {
  const uint8_t* at = content_.data() + line_header_bytes * lines;
  for (size_t i = 0; i < line; ++i)
    at += content_bytes(load<LineHeader>(content_.data() + line_header_bytes * i), at);
  return at;
}

void PackedTile::read(size_t line, size_t lines,
                      std::array<Fixed, PictureTiles::pixels>& sums) const {
  if (content_.empty()) return sums.fill(0);
  read_line(load<LineHeader>(content_.data() + line_header_bytes * line), content_of(line, lines),
            0, sums.size(), sums.data(), 1);
}

void PackedTile::read_pixels(size_t lines, size_t first, size_t count, Fixed* sums) const {
  if (content_.empty()) {
    std::fill_n(sums, lines * count, Fixed(0));
    return;
  }
  const uint8_t* content = content_.data() + line_header_bytes * lines;
  for (size_t line = 0; line < lines; ++line) {
    const auto header = load<LineHeader>(content_.data() + line_header_bytes * line);
    read_line(header, content, first, count, sums + line, lines);
    content += content_bytes(header, content);
  }
}

Fixed PackedTile::at(size_t line, size_t lines, size_t place) const {
  if (content_.empty()) return 0;
  Fixed sum;
  read_line(load<LineHeader>(content_.data() + line_header_bytes * line), content_of(line, lines),
            place, 1, &sum, 1);
  return sum;
}

TilePacker::TilePacker(size_t lines)
    : lines_(lines),
      buffer_(new uint8_t[lines * (line_header_bytes + SumLine::largest_packed) + word_slack]),
      unpacked_(std::make_unique<SumLine>()),
      other_(std::make_unique<SumLine>()) {}

void TilePacker::begin(const PackedTile& tile) {
  tile_ = &tile;
  line_ = 0;
  read_ = tile.content_.empty() ? nullptr : tile.content_.data() + line_header_bytes * lines_;
  written_ = buffer_.get() + line_header_bytes * lines_;
}

void TilePacker::keep() {
  uint8_t* header_at = buffer_.get() + line_header_bytes * line_;
  if (tile_->content_.empty()) {
    store(header_at, LineHeader{});
  } else {
    const auto header = load<LineHeader>(tile_->content_.data() + line_header_bytes * line_);
    store(header_at, header);
    const size_t bytes = content_bytes(header, read_);
    std::memcpy(written_, read_, bytes);
    read_ += bytes;
    written_ += bytes;
  }
  ++line_;
}

SumLine& TilePacker::next_line() {
  if (tile_->content_.empty())
    unpacked_->clear();
  else
    read_ = unpacked_->unpack(tile_->content_.data() + line_header_bytes * line_, read_);
  return *unpacked_;
}

void TilePacker::put_line() {
  written_ = unpacked_->pack(buffer_.get() + line_header_bytes * line_, written_);
  ++line_;
}

void TilePacker::add_line_of(const PackedTile& other) {
  if (other.content_.empty()) return keep();
  other_->unpack(other.content_.data() + line_header_bytes * line_,
                 other.content_of(line_, lines_));
  add(*other_);
}

void TilePacker::end(PackedTile& tile) {
  assert(line_ == lines_ && &tile == tile_);
  const auto size = size_t(written_ - buffer_.get()) + word_slack;
  if (size == line_header_bytes * lines_ + word_slack) {
    tile.content_ = {};
    return;
  }
  std::memset(written_, 0, word_slack);
  if (tile.content_.size() == size)
    std::memcpy(tile.content_.data(), buffer_.get(), size);
  else
    tile.content_ = std::vector<uint8_t>(buffer_.get(), buffer_.get() + size);
}

}  // namespace kaustik
