#pragma once
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "kaustik/render/checkpoint.h"
#include "kaustik/render/film_errors.h"

namespace kaustik::python {

/// Finished passes, immutable; Python's `Film`.
struct KeptFilm {
  std::shared_ptr<const Checkpoint> checkpoint;

  /// Found out when they are first asked for.
  const FilmErrors& errors() const;
  /// Bytes that are alike for the same passes of the same scene.
  std::vector<uint8_t> sums() const;

  struct LazyErrors {
    std::once_flag once;
    std::optional<FilmErrors> errors;
  };
  std::shared_ptr<LazyErrors> errors_ = std::make_shared<LazyErrors>();
};

}  // namespace kaustik::python
