#pragma once
#include "kaustik/live/engine.h"

namespace kaustik {

/// A render that somebody watches: what can be seen of it. All functions may be called from any
/// thread; they mean what they mean to Engine.
class Watched {
 public:
  Watched() = default;
  virtual ~Watched() = default;
  Watched(const Watched&) = delete;
  Watched& operator=(const Watched&) = delete;

  virtual EngineStatus status() const = 0;
  virtual std::shared_ptr<const Snapshot> snapshot() const = 0;
  virtual std::shared_ptr<const Snapshot> wait_for_snapshot(
      uint64_t after, std::chrono::milliseconds timeout) const = 0;
  virtual bool look_at_film(const std::function<void(const Film&)>& look) const = 0;
  virtual std::optional<Image> finished_snapshot() const = 0;
  virtual std::shared_ptr<const Scene> scene() const = 0;
};

/// What an engine renders.
class WatchedEngine final : public Watched {
 public:
  /// `engine` must outlive this.
  explicit WatchedEngine(const Engine& engine) : engine_(engine) {}

  EngineStatus status() const override { return engine_.status(); }
  std::shared_ptr<const Snapshot> snapshot() const override { return engine_.snapshot(); }
  std::shared_ptr<const Snapshot> wait_for_snapshot(
      uint64_t after, std::chrono::milliseconds timeout) const override {
    return engine_.wait_for_snapshot(after, timeout);
  }
  bool look_at_film(const std::function<void(const Film&)>& look) const override {
    return engine_.look_at_film(look);
  }
  std::optional<Image> finished_snapshot() const override { return engine_.finished_snapshot(); }
  std::shared_ptr<const Scene> scene() const override { return engine_.scene(); }

 private:
  const Engine& engine_;
};

}  // namespace kaustik
