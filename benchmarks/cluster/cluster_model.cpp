// A model, no measurement: how well 1 to 10 000 nodes render one picture together, in a job that
// takes ten minutes of rendering. Nodes fail, some are slow, and one file server has the scene.
// What could be measured here is read from the file that cluster_bench.py has written; the rest is
// assumed (machines.h).
//
// "team-model" is the efficiency of kaustik-mpi: the time of the same passes on all nodes at full
// speed, without anything else, over the time of the job; with the shares of the time that are
// lost, by what takes them. "read by all" is the same where all nodes read the scene from the file
// server, "learned before" with --learned, and "uneven passes" where the times of a node's passes
// differ by 5 % instead of 2 %. "array-model" is that of parts, as of a job array.
//
// `cluster_model [MEASURED.json]`
#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "benchmarks/cluster/array_run.h"
#include "benchmarks/cluster/team_run.h"
#include "benchmarks/report.h"
#include "kaustik/base/error.h"

namespace {

using namespace kaustik::bench;

constexpr uint32_t most_nodes = 10000;
/// With failures in some of them.
constexpr uint64_t jobs = 150;
constexpr Bar bar{0.85, 0.9};

std::string losses(const JobTime& sum) {
  std::string text;
  for (size_t i = 0; i < loss_names.size(); ++i)
    text += fmt::format("{}{} {:.1f} %", i > 0 ? ", " : "", loss_names[i],
                        100 * std::max(sum.lost_s[i], 0.0) / sum.seconds);
  return text;
}

void report_team(const std::string& name, const Machines& machines, uint32_t nodes, bool broadcasts,
                 const Bar& asked = {}) {
  JobTime sum;
  double longest_s = 0;
  for (uint64_t job = 0; job < jobs; ++job) {
    const JobTime time = TeamRun(machines, nodes, broadcasts, job).run();
    sum.seconds += time.seconds;
    sum.ideal_s += time.ideal_s;
    for (size_t i = 0; i < loss_names.size(); ++i) sum.lost_s[i] += time.lost_s[i];
    longest_s = std::max(longest_s, time.seconds);
  }
  report(name, sum.ideal_s / sum.seconds, "of the ideal",
         fmt::format("{}; longest of {} jobs {:.0f} s", losses(sum), jobs, longest_s), asked);
}

void report_array(const Machines& machines, uint32_t nodes) {
  constexpr uint32_t parts_per_node = 4;
  const ArrayTime time = run_array(machines, nodes, parts_per_node, 1);
  report(fmt::format("array-model {}", nodes), time.ideal_s / time.seconds, "of the ideal",
         fmt::format("{} parts; the file server reads {:.0f} s and writes {:.0f} s, merging takes "
                     "{:.0f} s",
                     nodes * parts_per_node, time.reading_s, time.writing_s, time.merging_s));
}

}  // namespace

int main(int argc, char** argv) {
  Machines machines;
  try {
    if (argc > 1) measured_from(argv[1], machines);
  } catch (const kaustik::Error& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 2;
  }
  for (uint32_t nodes = 1; nodes <= most_nodes; nodes *= 10)
    report_team(fmt::format("team-model {}", nodes), machines, nodes, true,
                nodes == most_nodes ? bar : Bar{});
  Machines other = machines;
  other.learned = true;
  report_team("team-model 10000, learned before", other, most_nodes, true);
  other = machines;
  other.pass_spread = 0.05;
  report_team("team-model 10000, uneven passes", other, most_nodes, true);
  report_team("team-model 10000, read by all", machines, most_nodes, false);
  for (uint32_t nodes = 1; nodes <= most_nodes; nodes *= 10) report_array(machines, nodes);
}
