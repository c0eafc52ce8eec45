#include "kaustik/render/packed_tile.h"

#include <algorithm>
#include <bit>
#include <cassert>

namespace kaustik {
namespace {

/// A little more than its bytes: tiles grow slowly, and with some room they stay where they are.
size_t room_for(size_t bytes) {
  const size_t step = std::max<size_t>(std::bit_floor(bytes) / 16, 1);
  return (bytes + step - 1) / step * step;
}

}  // namespace

std::span<const uint8_t> PackedTile::packed() const {
  if (content_.empty()) return {};
  return std::span(content_).first(content_.size() - word_slack);
}

bool is_packed_tile(std::span<const uint8_t> bytes, size_t lines) {
  if (bytes.empty()) return true;
  size_t at = line_header_bytes * lines;
  if (bytes.size() < at) return false;
  for (size_t line = 0; line < lines; ++line) {
    const auto header = load<LineHeader>(bytes.data() + line_header_bytes * line);
    const auto size = checked_content_bytes(header, bytes.data() + at, bytes.size() - at);
    if (!size) return false;
    at += *size;
  }
  return at == bytes.size();
}

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

const uint8_t* TilePacker::header_here() const {
  return tile_->content_.data() + line_header_bytes * line_;
}

void TilePacker::copy_line(const LineHeader& header, const uint8_t* content, size_t size) {
  store(buffer_.get() + line_header_bytes * line_, header);
  std::memcpy(written_, content, size);
  written_ += size;
  ++line_;
}

void TilePacker::keep() {
  if (!read_) return copy_line({}, written_, 0);
  const auto header = load<LineHeader>(header_here());
  const size_t size = content_bytes(header, read_);
  copy_line(header, read_, size);
  read_ += size;
}

SumLine& TilePacker::next_line() {
  if (read_)
    read_ = unpacked_->unpack(header_here(), read_);
  else
    unpacked_->clear();
  return *unpacked_;
}

void TilePacker::put_line() {
  written_ = unpacked_->pack(buffer_.get() + line_header_bytes * line_, written_);
  ++line_;
}

std::span<const uint8_t> TilePacker::written() const {
  const auto size = size_t(written_ - buffer_.get());
  // Without contents all is zero.
  if (size == line_header_bytes * lines_) return {};
  return {buffer_.get(), size};
}

void TilePacker::end(PackedTile& tile) {
  assert(line_ == lines_ && &tile == tile_);
  if (written().empty()) {
    tile.content_ = std::vector<uint8_t>();
    return;
  }
  std::memset(written_, 0, word_slack);
  const size_t size = written().size() + word_slack;
  if (tile.content_.capacity() != room_for(size)) {
    tile.content_ = std::vector<uint8_t>();
    tile.content_.reserve(room_for(size));
  }
  tile.content_.assign(buffer_.get(), buffer_.get() + size);
}

void TilePacker::add_packed(PackedTile& tile, std::span<const uint8_t> packed) {
  if (packed.empty()) return;
  begin(tile);
  const uint8_t* content = packed.data() + line_header_bytes * lines_;
  while (line_ < lines_) {
    const uint8_t* header_at = packed.data() + line_header_bytes * line_;
    const auto header = load<LineHeader>(header_at);
    const size_t size = content_bytes(header, content);
    if (header.is_zero()) {
      keep();
    } else if (!read_ || load<LineHeader>(header_here()).is_zero()) {
      copy_line(header, content, size);
    } else {
      other_->unpack(header_at, content);
      add(*other_);
    }
    content += size;
  }
  end(tile);
}

std::span<const uint8_t> TilePacker::repacked(const PackedTile& tile) {
  begin(tile);
  if (!read_) return {};
  std::array<Fixed, SumLine::count> sums;
  while (line_ < lines_) {
    if (load<LineHeader>(header_here()).is_zero()) {
      keep();
      continue;
    }
    next_line().read(sums);
    unpacked_->clear();
    unpacked_->add(sums);
    put_line();
  }
  return written();
}

}  // namespace kaustik
