#pragma once
#include <cstdint>
#include <memory>
#include <mutex>

namespace kaustik {

/// Something immutable that passes share and that is made when one first asks for it. Thread-safe.
template <typename Value>
class Kept {
 public:
  /// That of the key, by `make()` if the last one kept was another's. Null, and nothing is kept, if
  /// that is what it makes. It is called outside the lock: it runs in parallel, and a thread that
  /// waits for the others may take up any work meanwhile, this one's too. So several may make it at
  /// the same time.
  template <typename Make>
  std::shared_ptr<const Value> get(uint64_t key, const Make& make) {
    {
      const std::lock_guard lock(mutex_);
      if (value_ && key_ == key) return value_;
    }
    std::shared_ptr<const Value> made = make();
    if (!made) return nullptr;
    const std::lock_guard lock(mutex_);
    key_ = key;
    value_ = made;
    return made;
  }

 private:
  std::mutex mutex_;
  std::shared_ptr<const Value> value_;
  uint64_t key_ = 0;
};

}  // namespace kaustik
