#include "kaustik/loader/xml_encoding.h"

#include "kaustik/base/error.h"

namespace kaustik {
namespace {

/// Length of the UTF-8 sequence (RFC 3629) at the start of `text`, 0 if there is none.
size_t utf8_length(std::string_view text) {
  const auto byte = [&](size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return 1;
  const size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < length) return 0;
  for (size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xc0) != 0x80) return 0;
  // Overlong forms, surrogates, and what lies above U+10FFFF.
  if (first == 0xe0 && byte(1) < 0xa0) return 0;
  if (first == 0xed && byte(1) > 0x9f) return 0;
  if (first == 0xf0 && byte(1) < 0x90) return 0;
  if (first == 0xf4 && byte(1) > 0x8f) return 0;
  return length;
}

}  // namespace

void check_encoding(std::string_view text, const TextPlaces& places) {
  const auto fail = [&](size_t at, const char* message, const char* remedy) {
    throw Error(ErrorKind::input, message, remedy, places.at(at));
  };
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
    fail(0, "the file is UTF-16 text", "save it as UTF-8");
  for (size_t i = 0; i < text.size();) {
    if (text[i] == 0)
      fail(i, "a zero byte: this is not XML text", "give a Mitsuba XML scene, saved as UTF-8");
    const size_t length = utf8_length(text.substr(i));
    if (length == 0) fail(i, "a byte that is not UTF-8", "save the file as UTF-8");
    i += length;
  }
}

}  // namespace kaustik
