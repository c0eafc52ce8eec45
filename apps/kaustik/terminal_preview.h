#pragma once
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "kaustik/display/screen_pixels.h"
#include "kaustik/display/terminal.h"
#include "kaustik/image/tone_mapping.h"
#include "picture_viewer.h"

namespace kaustik::app {

/// The picture in the terminal that standard error is, above the line of progress.
class TerminalPreview final : public PictureViewer {
 public:
  TerminalPreview(TerminalKind kind, std::shared_ptr<const ToneOperator> tone);
  bool is_ready() const override;
  void show(const Image& image) override;

 private:
  std::string drawn(const ScreenPixels& pixels, const PicturePlace& place);

  const TerminalKind kind_;
  const std::shared_ptr<const ToneOperator> tone_;
  std::chrono::steady_clock::time_point next_;
  uint32_t first_id_;  ///< kitty's number of the first of two pictures, which take turns
  uint32_t shown_ = 0;
};

}  // namespace kaustik::app
