#pragma once
#include "kaustik/image/image.h"

namespace kaustik::app {

/// Somewhere that a running picture is shown.
class PictureViewer {
 public:
  virtual ~PictureViewer() = default;
  /// Whether it takes another picture now.
  virtual bool is_ready() const = 0;
  virtual void show(const Image& image) = 0;
  /// Called once, after the last picture was shown: waits until it is seen, but not for long.
  virtual void finish() {}
};

}  // namespace kaustik::app
