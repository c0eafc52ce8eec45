#include "kaustik/render/program_version.h"

#include <fmt/format.h>

#include "kaustik/base/error.h"

namespace kaustik {

void check_program(const std::string& path, const std::string& written_by,
                   const std::string& program) {
  if (written_by == program) return;
  throw Error(ErrorKind::input,
              fmt::format("this file was written by Kaustik {}, this program is {}: their passes "
                          "may differ",
                          written_by, program),
              "use that version, or write the file again with this one", place_in(path));
}

}  // namespace kaustik
