#pragma once
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace kaustik {

/// Items of its own, or somebody else's that are only read: those of a file that is mapped into
/// memory.
template <typename T>
class KeptArray {
 public:
  KeptArray() = default;
  explicit KeptArray(std::vector<T> items) : own_(std::move(items)) {}
  /// Items that `owner` keeps alive and nobody changes.
  KeptArray(std::span<const T> items, std::shared_ptr<const void> owner)
      : others_(items), owner_(std::move(owner)) {}

  size_t size() const { return owner_ ? others_.size() : own_.size(); }
  const T* data() const { return owner_ ? others_.data() : own_.data(); }
  const T& operator[](size_t i) const { return data()[i]; }
  std::span<const T> all() const { return {data(), size()}; }
  /// Of memory that nobody else has.
  size_t own_bytes() const { return own_.capacity() * sizeof(T); }
  /// To be changed; others' items are copied first.
  std::vector<T>& own() {
    if (owner_) {
      own_.assign(others_.begin(), others_.end());
      others_ = {};
      owner_.reset();
    }
    return own_;
  }

 private:
  std::vector<T> own_;
  std::span<const T> others_;
  std::shared_ptr<const void> owner_;  ///< null: they are its own
};

}  // namespace kaustik
