#pragma once
#include <string>

#include "kaustik/image/image_io.h"

namespace kaustik::app {

// As what image_io.h has without "picture", but for standard output too: "-", or with a format
// "png:-". Without one it is EXR, of pictures for displays PNG.

/// Whether the picture is written in a format that has layers.
bool picture_holds_layers(const std::string& file);

void check_picture_writable(const std::string& file);
void check_shown_picture_writable(const std::string& file);
void write_picture(const Image& image, const std::string& file, const WriteOptions& options);
void write_shown_picture(const Image& shown, const std::string& file, int jpeg_quality);

/// "a.exr", or "standard output".
std::string picture_name(const std::string& file);

}  // namespace kaustik::app
