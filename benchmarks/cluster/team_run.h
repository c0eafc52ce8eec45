#pragma once
#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include "benchmarks/cluster/machines.h"
#include "kaustik/render/team_pace.h"

namespace kaustik::bench {

/// Where the time of a job goes that is not rendering at full speed.
enum class Loss { launch, load, learning, rounds, adding, failures };
inline constexpr std::array loss_names = {"launch",  "loading",   "learning",
                                          "waiting", "adding up", "failures"};

/// How a job went.
struct JobTime {
  double seconds = 0, ideal_s = 0;
  std::array<double, loss_names.size()> lost_s{};
};

/// One job of kaustik-mpi on so many nodes, by discrete events: in each round nodes end their
/// passes one after the other, and one may fail before that. A failure ends all; the job begins
/// again from what was added up. Passes are shared out by the program's own TeamPace.
class TeamRun {
 public:
  /// `broadcasts`: the scene comes from the leader; else all read it from the file server.
  TeamRun(const Machines& machines, uint32_t nodes, bool broadcasts, uint64_t seed);
  JobTime run();

 private:
  /// False: a node has failed meanwhile.
  bool spend(double seconds, Loss loss);
  bool begin();
  bool learn();
  bool render();
  /// A round of at most so many passes; how many there were, none if a node has failed.
  uint64_t round(uint64_t most, double seconds, Loss loss);
  bool add_up();
  void fail();
  double broadcast_s(double gigabytes) const;
  double pass_s(uint32_t node);

  const Machines& machines_;
  uint32_t nodes_;
  bool broadcasts_;
  std::mt19937_64 random_;
  std::vector<double> speed_;  ///< of nodes
  TeamPace pace_;
  JobTime time_;
  double failure_s_ = 0;    ///< when the next node fails
  double added_up_s_ = 0;   ///< when films were added up
  uint64_t passes_, left_;  ///< of the job; that are to be rendered
  uint64_t safe_left_;      ///< the same if a node fails now
};

}  // namespace kaustik::bench
