#pragma once
// A TIFF file in memory, for the decoder and the encoder.

#include <tiffio.h>

#include <memory>
#include <string>

#include "kaustik/image/formats.h"

namespace kaustik::formats {

/// The file as libtiff's client functions see it.
struct MemoryTiff {
  Bytes written;
  ByteView readable;
  size_t position = 0;
  bool is_writing = false;
  std::string error;  ///< the first that libtiff reported

  ByteView contents() const { return is_writing ? ByteView(written) : readable; }
};

struct CloseTiff {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};
using TiffPointer = std::unique_ptr<TIFF, CloseTiff>;

/// Throws what the file's error tells: std::bad_alloc where memory was lacking, else BadImage.
[[noreturn]] void fail(const MemoryTiff& file);

/// `mode` as in TIFFOpen(); no more than `most_bytes` are allocated at once.
TiffPointer open_tiff(MemoryTiff& file, const char* mode, int64_t most_bytes);

}  // namespace kaustik::formats
