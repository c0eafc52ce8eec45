#pragma once
#include <string>

namespace kaustik {

/// Throws Error(input), at `path`, if what wrote that file, version `written_by`, is not version
/// `program`: passes of different versions do not belong together, nor do lessons to them.
void check_program(const std::string& path, const std::string& written_by,
                   const std::string& program);

}  // namespace kaustik
