#include "picture_file.h"

#include <unistd.h>

#include "kaustik/base/error.h"
#include "standard_streams.h"

namespace kaustik::app {
namespace {

/// What the picture would be called as a file, for its format and for messages.
std::string stream_name(const std::string& file, const std::string& usual_format) {
  const std::string format = file.substr(0, file.size() - 1);  // "png:"
  return "standard output." + (format.empty() ? usual_format : format.substr(0, format.size() - 1));
}

void check_no_terminal() {
  if (isatty(STDOUT_FILENO) != 0)
    throw Error(ErrorKind::input, "standard output is a terminal, which cannot show a picture",
                "send it to a program or a file: kaustik … -o - | …");
}

}  // namespace

void check_picture_writable(const std::string& file) {
  if (!is_standard_stream(file)) return check_writable(file);
  check_extension(stream_name(file, "exr"));
  check_no_terminal();
}

bool picture_holds_layers(const std::string& file) {
  return holds_layers(is_standard_stream(file) ? stream_name(file, "exr") : file);
}

void check_shown_picture_writable(const std::string& file) {
  if (!is_standard_stream(file)) return check_shown_writable(file);
  check_shown_extension(stream_name(file, "png"));
  check_no_terminal();
}

void write_picture(const Image& image, const std::string& file, const WriteOptions& options) {
  if (is_standard_stream(file))
    write_standard_output(encode_image(image, stream_name(file, "exr"), options));
  else
    write_image(image, file, options);
}

void write_shown_picture(const Image& shown, const std::string& file, int jpeg_quality) {
  if (is_standard_stream(file))
    write_standard_output(encode_shown_image(shown, stream_name(file, "png"), jpeg_quality));
  else
    write_shown_image(shown, file, jpeg_quality);
}

std::string picture_name(const std::string& file) {
  return is_standard_stream(file) ? "standard output" : file;
}

}  // namespace kaustik::app
