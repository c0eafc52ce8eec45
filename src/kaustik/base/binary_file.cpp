#include "kaustik/base/binary_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "kaustik/base/checksum.h"
#include "kaustik/base/error.h"
#include "kaustik/base/file.h"

namespace kaustik {
namespace {

constexpr uint32_t byte_order_mark = 0x01020304, swapped_byte_order_mark = 0x04030201;
constexpr size_t checksum_size = sizeof(uint64_t);
/// That are read at a time: few enough to be still in the cache when they are looked at.
constexpr size_t piece_bytes = size_t{1} << 18;

bool starts_with(std::span<const uint8_t> bytes, const std::array<uint8_t, 8>& magic) {
  return bytes.size() >= magic.size() && std::equal(magic.begin(), magic.end(), bytes.begin());
}

}  // namespace

BinaryWriter::BinaryWriter(const BinaryFileKind& kind) {
  put(kind.magic);
  put(byte_order_mark);
  put(kind.version);
}

void BinaryWriter::put_bytes(const void* data, size_t size) {
  const auto* bytes = static_cast<const uint8_t*>(data);
  bytes_.insert(bytes_.end(), bytes, bytes + size);
}

void BinaryWriter::put_text(const std::string& text) {
  put(uint64_t(text.size()));
  put_bytes(text.data(), text.size());
}

void BinaryWriter::write_to(const std::string& path) { write_file_atomically(path, finished()); }

bool BinaryWriter::write_to_if(const std::string& path, const std::function<bool()>& is_wanted) {
  return write_file_atomically_if(path, finished(), is_wanted);
}

std::vector<uint8_t> BinaryWriter::finished() {
  put(checksum(bytes_));
  return std::move(bytes_);
}

void add_checksum(AtomicFile& file, uint64_t size) {
  RunningChecksum sum(size);
  std::vector<uint8_t> piece(size_t(std::min<uint64_t>(size, piece_bytes)));
  for (uint64_t at = 0; at < size;) {
    const auto part = std::span(piece).first(size_t(std::min<uint64_t>(size - at, piece_bytes)));
    file.read(at, part);
    sum.add(part);
    at += part.size();
  }
  std::array<uint8_t, checksum_size> bytes;
  const uint64_t value = sum.value();
  std::memcpy(bytes.data(), &value, checksum_size);
  file.write(size, bytes);
}

BinaryReader::BinaryReader(const BinaryFileKind& kind, const std::string& path, FileCheck check)
    : kind_(kind), path_(path), file_(std::make_unique<const InputFile>(path)) {
  size_ = unloaded_ = file_->size();
  check_frame(check);
}

BinaryReader::BinaryReader(const BinaryFileKind& kind, std::vector<uint8_t> bytes,
                           const std::string& name)
    : kind_(kind), path_(name), bytes_(std::move(bytes)), rest_(bytes_), size_(bytes_.size()) {
  check_frame(FileCheck::whole);
}

BinaryReader::~BinaryReader() = default;

void BinaryReader::fail(const std::string& what, const std::string& remedy) const {
  throw Error(ErrorKind::input, what, remedy, place_in(path_));
}

void BinaryReader::damaged(const std::string& why) const {
  fail(fmt::format("the {} is damaged: {}", kind_.name, why), kind_.if_unusable);
}

void BinaryReader::check_frame(FileCheck check) {
  load(std::min<uint64_t>(size_, kind_.magic.size()));
  if (!starts_with(rest_, kind_.magic))
    fail(fmt::format("this is not a {}", kind_.name), kind_.if_foreign);
  rest_ = rest_.subspan(kind_.magic.size());
  const auto order = get<uint32_t>();
  if (order == swapped_byte_order_mark)
    fail(fmt::format("the {} was written on a machine of the other byte order", kind_.name),
         "write it again on this kind of machine");
  if (order != byte_order_mark) damaged("its header is not valid");
  const auto version = get<uint32_t>();
  if (version != kind_.version)
    fail(fmt::format("the {} has version {}, this program reads version {}", kind_.name, version,
                     kind_.version),
         kind_.if_unusable);
  if (rest_.size() + unloaded_ < checksum_size) damaged("it is truncated");
  if (check == FileCheck::whole && stored_checksum() != checksum_of_content())
    damaged("its checksum does not match, it is truncated or bytes have changed");
  // What follows is the content.
  const size_t loaded_part = checksum_size - std::min<uint64_t>(unloaded_, checksum_size);
  unloaded_ -= checksum_size - loaded_part;
  rest_ = rest_.first(rest_.size() - loaded_part);
}

uint64_t BinaryReader::stored_checksum() const {
  std::array<uint8_t, checksum_size> bytes{};
  if (!file_)
    std::copy(bytes_.end() - checksum_size, bytes_.end(), bytes.begin());
  else if (file_->read(size_ - checksum_size, bytes) < checksum_size)
    damaged("it is truncated");
  uint64_t sum;
  std::memcpy(&sum, bytes.data(), checksum_size);
  return sum;
}

uint64_t BinaryReader::checksum_of_content() const {
  const uint64_t content = size_ - checksum_size;
  if (!file_) return checksum(std::span(bytes_).first(content));
  RunningChecksum sum(content);
  std::vector<uint8_t> piece(size_t(std::min<uint64_t>(content, piece_bytes)));
  for (uint64_t at = 0; at < content;) {
    const auto part = std::span(piece).first(size_t(std::min<uint64_t>(content - at, piece_bytes)));
    if (file_->read(at, part) < part.size()) damaged("it is truncated");
    sum.add(part);
    at += part.size();
  }
  return sum.value();
}

void BinaryReader::load_from_file(size_t count) {
  if (count > rest_.size() + unloaded_) damaged("it is truncated");
  const size_t kept = rest_.size();
  const auto more = size_t(std::min<uint64_t>(unloaded_, std::max(count - kept, piece_bytes)));
  if (kept > 0) std::memmove(bytes_.data(), rest_.data(), kept);
  if (bytes_.size() < kept + more) bytes_.resize(kept + more);
  if (file_->read(unloaded_begin_, std::span(bytes_).subspan(kept, more)) < more)
    damaged("it is truncated");
  unloaded_ -= more;
  unloaded_begin_ += more;
  rest_ = std::span(bytes_).first(kept + more);
}

void BinaryReader::skip_to(uint64_t position) {
  uint64_t count = position - this->position();
  need(count, 1);
  const auto loaded = size_t(std::min<uint64_t>(count, rest_.size()));
  rest_ = rest_.subspan(loaded);
  count -= loaded;
  unloaded_ -= count;
  unloaded_begin_ += count;
}

std::shared_ptr<const std::span<const uint8_t>> BinaryReader::mapped() const {
  return file_->mapped();
}

void BinaryReader::copy_to(uint8_t* out, uint64_t count) {
  while (count > 0) {
    load(1);
    const auto bytes = rest_.first(size_t(std::min<uint64_t>(count, rest_.size())));
    std::memcpy(out, bytes.data(), bytes.size());
    rest_ = rest_.subspan(bytes.size());
    out += bytes.size();
    count -= bytes.size();
  }
}

std::span<const uint8_t> BinaryReader::get_bytes(uint64_t count) {
  need(count, 1);
  load(count);
  const auto bytes = rest_.first(count);
  rest_ = rest_.subspan(count);
  return bytes;
}

std::span<const uint8_t> BinaryReader::bytes_ahead(size_t least) {
  load(size_t(std::min<uint64_t>(least, rest_.size() + unloaded_)));
  return rest_;
}

std::string BinaryReader::get_text() {
  const auto bytes = get_bytes(get<uint64_t>());
  return {bytes.begin(), bytes.end()};
}

bool BinaryReader::get_flag() {
  const auto value = get<uint8_t>();
  if (value > 1) damaged("a setting in it is not valid");
  return value == 1;
}

uint64_t BinaryReader::get_count(size_t item_size) {
  const auto count = get<uint64_t>();
  need(count, item_size);
  return count;
}

void BinaryReader::expect_end() const {
  if (!rest_.empty() || unloaded_ > 0) damaged("something follows its end");
}

bool is_of_kind(const BinaryFileKind& kind, const std::string& path) {
  return starts_with(read_file_start(path, kind.magic.size()), kind.magic);
}

}  // namespace kaustik
