#pragma once
#include <map>
#include <memory>
#include <mutex>

namespace kaustik {

/// Things that take time to make and are the same for all who ask with the same key; each lives as
/// long as somebody holds it. Thread-safe.
template <typename Key, typename Thing>
class SharedByKey {
 public:
  template <typename Make>
  std::shared_ptr<const Thing> get(const Key& key, const Make& make) {
    const std::lock_guard lock(mutex_);
    std::weak_ptr<const Thing>& known = all_[key];
    if (auto thing = known.lock()) return thing;
    std::shared_ptr<const Thing> made = make();
    known = made;
    return made;
  }

 private:
  std::mutex mutex_;
  std::map<Key, std::weak_ptr<const Thing>> all_;
};

}  // namespace kaustik
