#pragma once
#include <optional>
#include <string>
#include <vector>

#include "kaustik/loader/render_events.h"
#include "study_parts.h"

namespace kaustik::app {

/// What a study has found so far, as a table with a row for each value: the part's name, the labels
/// of its factors, where a meter stands (empty: the mean of a picture), the value, half the width
/// of its 95 % interval (empty: not known), the unit, passes, samples per pixel, and seconds.
struct StudyTable {
  std::string text;                  ///< comma-separated, with a first line of titles
  std::vector<std::string> missing;  ///< parts that are not done
};
StudyTable table_of(const Study& study, const std::vector<StudyPart>& parts);

/// What the part has told, if it is done: rendered to its end by this very command, with a value at
/// least.
std::optional<RenderEvents> result_of(const Study& study, const StudyPart& part);

}  // namespace kaustik::app
