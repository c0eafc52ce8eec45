#include "meter_table.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "file_names.h"
#include "kaustik/base/error.h"
#include "kaustik/base/file.h"

namespace kaustik::app {

bool is_table(const std::string& file) { return extension_of(file) == "csv"; }

void check_tables(const OutputPlan& outputs, const Scene& scene) {
  if (is_meter(scene)) return;
  for (const std::string& file : outputs.files)
    if (is_table(file))
      throw Error(
          ErrorKind::input,
          fmt::format("'{}' is a table of what a meter shows, and the camera is none", file),
          "write a picture (-o picture.exr), choose a meter of the scene (--camera ID), "
          "or give points to measure at (--points FILE)");
}

void write_table(const std::vector<Measurement>& list, const std::string& unit,
                 const std::string& file) {
  std::string text = "x,y,z,value,half_width,unit\n";
  for (const Measurement& one : list)
    fmt::format_to(std::back_inserter(text), "{},{},{},{:.9g},{},{}\n", one.position.x,
                   one.position.y, one.position.z, one.value,
                   std::isfinite(one.half_width) ? fmt::format("{:.4g}", one.half_width) : "",
                   unit);
  write_text_atomically(file, text);
}

}  // namespace kaustik::app
