#pragma once
#include <cstdint>
#include <string>

namespace kaustik::bench {

/// What the model of a cluster goes by. Nothing of it is measured but what `measured_from` reads.
struct Machines {
  // The job
  double job_s = 600;     ///< of rendering, on all nodes at full speed
  double pass_s = 4;      ///< of a node
  double film_gb = 1.66;  ///< 1080p with all components and layers, 16 bytes a sum
  double file_gb = 0.52;  ///< the same as a checkpoint
  double scene_gb = 1;
  double lesson_gb = 0.006;  ///< what a pass teaches
  double interval_s = 300;   ///< --every
  bool learned = false;      ///< --learned: the job has nothing to learn
  // The cluster
  double launch_s = 15, launch_level_s = 0.5;  ///< of any number, and for each doubling of it
  double requeue_s = 60;                       ///< until a job that has died runs again
  double server_gb_s = 5, link_gb_s = 12.5;    ///< of the file server; of a node, 100 Gbit/s
  double message_s = 20e-6;
  double mean_life_s = 5 * 365.25 * 86400;  ///< of a node
  double slow_share = 0.01, slow_speed = 0.5;
  double pass_spread = 0.02;  ///< standard deviation of a pass's time on one node, of the mean
  // The program
  double build_s = 10;      ///< a process starts, and builds its scene
  double report_s = 10e-6;  ///< the leader takes a report
  double reduction = 1.3;   ///< time of adding up, of what the bandwidth allows
  double merge_gb_s = 0.5;  ///< of files, by one process
};

/// Replaces what benchmarks/cluster/cluster_bench.py has measured, a file of JSON. Throws
/// Error(input).
void measured_from(const std::string& path, Machines& machines);

}  // namespace kaustik::bench
