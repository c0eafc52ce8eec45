#pragma once
#include <functional>
#include <memory>

#include "kaustik/live/watched.h"

namespace kaustik::view {

/// What viewers may do to a render that a program steers. From any thread.
struct SessionControls {
  std::function<void()> pause, resume, stop;
  /// Session::refine(); false, too, where nothing is rendered.
  std::function<bool(const RegionRequest&)> refine;
};

/// A render that a program steers, for a view that only shows it.
struct ShownSession {
  std::shared_ptr<const Watched> render;
  SessionControls controls;
};

}  // namespace kaustik::view
