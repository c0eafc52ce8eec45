#include "workplace.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "kaustik/base/file.h"
#include "kaustik/image/image_io.h"
#include "kaustik/image/tone_mapping.h"

namespace kaustik::thesis {

int Workplace::scaled(int count) const { return std::max(1, int(std::lround(count * effort))); }

std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

bool Workplace::wants(const std::string& scene) const {
  return scenes.empty() || std::find(scenes.begin(), scenes.end(), scene) != scenes.end();
}

void Workplace::write_text(const std::filesystem::path& path, const std::string& text) const {
  std::filesystem::create_directories(path.parent_path());
  write_file_atomically(path.string(),
                        {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

std::string Workplace::show(const Image& image, const std::string& name, const std::string& alt,
                            float exposure, const std::string& layer) const {
  const std::filesystem::path file = std::filesystem::path("pictures") / (name + ".png");
  std::filesystem::create_directories((docs / file).parent_path());
  WriteOptions options;
  options.tone = make_tone_operator("linear", {fmt::format("exposure={}", exposure)});
  options.layer = layer;
  write_image(image, (docs / file).string(), options);
  return "![" + alt + "](" + file.string() + ")";
}

}  // namespace kaustik::thesis
