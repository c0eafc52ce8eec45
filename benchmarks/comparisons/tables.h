#pragma once
#include <string>
#include <vector>

#include "benchmarks/comparisons/results.h"
#include "benchmarks/line_plot.h"

namespace kaustik::bench {

// Tables in Markdown, over all scenes, at the last time of each unless they tell another. Ratios
// without the reference's noise are those of noiseless_ratio().

/// The error by every integrator at each time, the reference's own noise, and which build has
/// measured.
std::string error_table(const Results& results);

/// The headline's error over the least of all other integrators, at each time, where at least four
/// of them were measured, and what becomes of its bars on the scenes that ship. "" without the
/// headline.
std::string best_table(const Results& results);

/// The error of path tracing over the headline's, and what becomes of its bars.
std::string path_table(const Results& results);

/// The figures of other renderers beside ours, and what becomes of the bars. "" if none of their
/// scenes was measured.
std::string peer_table(const Results& results);

/// Means of the pictures relative to those of the references.
std::string mean_table(const Results& results);

/// Error over time by every integrator.
LinePlot error_plot(const Results& results, const std::string& scene);

}  // namespace kaustik::bench
