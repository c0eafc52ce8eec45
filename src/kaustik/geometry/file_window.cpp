#include "kaustik/geometry/file_window.h"

#include <algorithm>

namespace kaustik {
namespace {

constexpr size_t window_bytes = size_t{1} << 20;

}  // namespace

void FileWindow::move_to(uint64_t position) {
  first_ = std::min(position, file_.size());
  bytes_.clear();
  begin_ = 0;
}

void FileWindow::load(size_t count) {
  if (first_ + bytes_.size() >= file_.size()) return;
  bytes_.erase(bytes_.begin(), bytes_.begin() + std::ptrdiff_t(begin_));
  first_ += begin_;
  begin_ = 0;
  const size_t before = bytes_.size();
  const uint64_t wanted = std::max(count, window_bytes);
  const uint64_t end = std::min<uint64_t>(file_.size(), first_ + wanted);
  bytes_.resize(size_t(end - first_));
  bytes_.resize(before + file_.read(first_ + before, std::span(bytes_).subspan(before)));
}

}  // namespace kaustik
