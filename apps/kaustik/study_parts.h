#pragma once
#include <string>
#include <vector>

#include "kaustik/loader/study_file.h"

namespace kaustik::app {

/// One variant of a study: a render by itself, with files of its own.
struct StudyPart {
  std::string name;                    ///< of its files, without folder and extension
  std::vector<std::string> labels;     ///< of the values of each factor
  std::vector<std::string> arguments;  ///< of `kaustik`, "render" first
  /// The same as it would be given in the study's folder: what tells whether a part is done.
  std::string command;
};

/// The study's variants; the last factor varies fastest. Throws Error(input) for options that
/// `render` does not have, that are given twice, or that the study chooses itself, and for variants
/// of one name.
std::vector<StudyPart> parts_of(const Study& study);

/// Files of a part in the study's folder: lines of JSON that tell how the render goes, and the
/// command, which is there once the part is done.
std::string events_file(const Study& study, const StudyPart& part);
std::string command_file(const Study& study, const StudyPart& part);

/// A command as a shell takes it.
std::string command_line(const std::vector<std::string>& arguments);

}  // namespace kaustik::app
