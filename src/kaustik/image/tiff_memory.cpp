#include "kaustik/image/tiff_memory.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <new>
#include <string_view>

namespace kaustik::formats {
namespace {

MemoryTiff& file_of(thandle_t handle) { return *static_cast<MemoryTiff*>(handle); }

tmsize_t read_some(thandle_t handle, void* buffer, tmsize_t size) {
  MemoryTiff& file = file_of(handle);
  const ByteView contents = file.contents();
  if (file.position >= contents.size() || size <= 0) return 0;
  const size_t count = std::min(size_t(size), contents.size() - file.position);
  std::memcpy(buffer, contents.data() + file.position, count);
  file.position += count;
  return tmsize_t(count);
}

tmsize_t write_some(thandle_t handle, void* buffer, tmsize_t size) {
  MemoryTiff& file = file_of(handle);
  if (!file.is_writing || size < 0) return -1;
  const size_t end = file.position + size_t(size);
  // Nothing may be thrown through the library, which also writes when it is closed.
  try {
    if (end > file.written.size()) file.written.resize(end);
  } catch (const std::bad_alloc&) {
    if (file.error.empty()) file.error = "not enough memory";
    return -1;
  }
  std::memcpy(file.written.data() + file.position, buffer, size_t(size));
  file.position = end;
  return size;
}

toff_t seek_to(thandle_t handle, toff_t offset, int origin) {
  MemoryTiff& file = file_of(handle);
  if (origin == SEEK_SET) file.position = size_t(offset);
  if (origin == SEEK_CUR) file.position += size_t(offset);
  if (origin == SEEK_END) file.position = file.contents().size() + size_t(offset);
  return toff_t(file.position);
}

int close_nothing(thandle_t) { return 0; }
toff_t size_of(thandle_t handle) { return toff_t(file_of(handle).contents().size()); }

int keep_error(TIFF*, void* user_data, const char*, const char* format, va_list arguments) {
  char text[512];
  std::vsnprintf(text, sizeof(text), format, arguments);
  auto& file = *static_cast<MemoryTiff*>(user_data);
  if (file.error.empty()) file.error = text;
  return 1;  // do not call the global handler, which prints
}
/// Drops it, unless the file ends before the value of a tag: without it the unit or the field of
/// view would be wrong.
int drop_warning(TIFF* tiff, void* user_data, const char* module, const char* format,
                 va_list arguments) {
  if (std::string_view(format).starts_with("IO error"))
    return keep_error(tiff, user_data, module, format, arguments);
  return 1;
}

}  // namespace

// The name that the library is given must not have a word of those that fail_as_told() looks for.
void fail(const MemoryTiff& file) {
  fail_as_told(file.error.empty() ? "its TIFF structure is broken" : file.error);
}

TiffPointer open_tiff(MemoryTiff& file, const char* mode, int64_t most_bytes) {
  const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> options(TIFFOpenOptionsAlloc(),
                                                                             TIFFOpenOptionsFree);
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_error, &file);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), drop_warning, &file);
  TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), tmsize_t(most_bytes));
  TiffPointer tiff(TIFFClientOpenExt("picture", mode, &file, read_some, write_some, seek_to,
                                     close_nothing, size_of, nullptr, nullptr, options.get()));
  if (!tiff) fail(file);
  return tiff;
}

}  // namespace kaustik::formats
