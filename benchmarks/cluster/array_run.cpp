#include "benchmarks/cluster/array_run.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <random>

namespace kaustik::bench {
namespace {

/// Between two checkpoints, --every.
constexpr double every_s = 30;

/// One after the other: the server gives each its bytes, and to all together no more than it can.
class FileServer {
 public:
  explicit FileServer(const Machines& machines) : machines_(machines) {}
  /// When a file that is asked for at that time is there. Calls must come in the order of time.
  double done(double asked_s, double gigabytes) {
    free_s_ = std::max(asked_s, free_s_) + gigabytes / machines_.server_gb_s;
    return std::max(free_s_, asked_s + gigabytes / machines_.link_gb_s);
  }

 private:
  const Machines& machines_;
  double free_s_ = 0;
};

}  // namespace

ArrayTime run_array(const Machines& machines, uint32_t nodes, uint32_t parts_per_node,
                    uint64_t seed) {
  enum class Step { read, render, write };
  struct Event {
    double s;
    Step step;
    double speed;
    bool operator<(const Event& other) const { return s > other.s; }
  };
  std::mt19937_64 random(seed);
  std::bernoulli_distribution is_slow(machines.slow_share);
  std::exponential_distribution<double> life_s(1 / machines.mean_life_s);
  const uint64_t parts = uint64_t(nodes) * parts_per_node;
  const double part_s = machines.job_s / parts_per_node;
  FileServer server(machines);
  uint64_t waiting = parts;
  std::priority_queue<Event> events;
  // A node takes a part when it is free.
  for (uint32_t node = 0; node < nodes; ++node, --waiting)
    events.push({machines.launch_s, Step::read, is_slow(random) ? machines.slow_speed : 1});
  double end_s = 0;
  while (!events.empty()) {
    const auto [s, step, speed] = events.top();
    events.pop();
    switch (step) {
      case Step::read:
        events.push({server.done(s, machines.scene_gb) + machines.build_s, Step::render, speed});
        break;
      case Step::render: {
        const double takes_s = part_s / speed, fails_s = life_s(random);
        const bool fails = fails_s < takes_s;
        // The engine gives the part to somebody else, who goes on from its last checkpoint.
        const double lost_s = fails ? machines.requeue_s + machines.build_s + every_s : 0;
        events.push({s + takes_s + lost_s, Step::write, speed});
        break;
      }
      case Step::write:
        end_s = std::max(end_s, server.done(s, machines.file_gb));
        if (waiting == 0) break;
        --waiting;
        events.push({end_s, Step::read, speed});
        break;
    }
  }
  ArrayTime time;
  time.ideal_s = machines.job_s;
  time.reading_s = double(parts) * machines.scene_gb / machines.server_gb_s;
  time.writing_s = double(parts) * machines.file_gb / machines.server_gb_s;
  // √parts jobs at a time, of as many files, all from one server; then one of them all.
  const double wide = std::ceil(std::sqrt(double(parts)));
  const double of_each_s = wide * machines.file_gb / machines.merge_gb_s;
  time.merging_s = std::max(of_each_s, time.writing_s) + of_each_s;
  time.seconds = end_s + time.merging_s;
  return time;
}

}  // namespace kaustik::bench
