#pragma once
#include <cstdint>

#include "benchmarks/cluster/machines.h"

namespace kaustik::bench {

/// How an array of parts went.
struct ArrayTime {
  double seconds = 0, ideal_s = 0;
  double reading_s = 0, writing_s = 0, merging_s = 0;  ///< of it, at least
};

/// The same job as `parts_per_node` parts for each node, by an engine that hands the next part to
/// whoever is free: each reads the scene from the file server, renders with lessons that were
/// learned before, and writes its film there; a tree of merges of √parts each follows. A node that
/// fails costs what its part has not kept, and the part is given to another.
ArrayTime run_array(const Machines& machines, uint32_t nodes, uint32_t parts_per_node,
                    uint64_t seed);

}  // namespace kaustik::bench
