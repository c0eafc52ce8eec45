#pragma once
#include "kaustik/render/checkpoint.h"
#include "kaustik/render/messages.h"

namespace kaustik {

/// What a picture tells beside what its record knows.
struct PictureFacts {
  uint32_t passes = 0;             ///< that it shows
  uint64_t samples_per_pixel = 0;  ///< of these, on average
  int threads = 0;                 ///< for smoothing; 0: all
  bool incomplete_pass = false;    ///< the film holds fewer samples than a pass has
  double part = 0;                 ///< of a pass that the picture has beside these

  static PictureFacts of(const Film& film) {
    return {.passes = film.pass_count(), .samples_per_pixel = film.samples_per_pixel()};
  }
};

/// `image` as it is to be written: with its frame and what is known of it as metadata, and smoothed
/// if the record says so. A picture that can't be smoothed stays as it is, and a warning tells why.
Image finished_picture(Image image, const RenderRecord& record, const PictureFacts& facts,
                       const Messages& messages);

}  // namespace kaustik
