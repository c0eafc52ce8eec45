#include "benchmarks/comparisons/bench_scene.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "kaustik/base/error.h"

namespace kaustik::bench {
namespace {

const std::string root = KAUSTIK_SOURCE_DIR;
const std::string peer_prefix = "peer_";

constexpr std::array peer_renderers{
    "Mitsuba 0.6 path",        "Mitsuba 0.6 bdpt", "Mitsuba 0.6 sppm", "Mitsuba 0.6 photonmapper",
    "Tungsten progressive pm", "pbrt-v4 sppm",     "Cycles path"};

struct PeerRow {
  const char* name;
  std::array<double, peer_renderers.size()> relmse;
  double bar, aim;
};

/// The table of benchmarks/peer_scenes/README.md.
constexpr std::array peer_rows{
    PeerRow{"cornell", {0.00079, 0.0016, 0.0014, 0.0034, 0.0021, 0.0012, 0.00057}, 2, 0},
    PeerRow{"cornell_glass", {0.010, 0.0075, 0.0023, 0.0033, 0.0024, 0.0030, 0.016}, 3, 10},
    PeerRow{"ring", {0.12, 0.072, 0.0061, 0.0018, 0.011, 0.0030, 0.21}, 3, 10},
    PeerRow{"pool_above", {2.0, 2.2, 0.012, 0.015, 0.013, 0.017, 1.9}, 3, 10},
    PeerRow{"pool_below", {3.4, 1.7, 0.0044, 0.014, 0.0060, 0.014, 3.9}, 3, 10},
    PeerRow{"hidden_light", {0.084, 0.010, 0.0058, 0.021, 0.0072, 0.0071, 0.068}, 2, 0}};

double path_bar(const std::string& name) {
  if (name == "cornell_spheres") return 3;
  return name == "metal_ring" || name == "pool_below" || name == "atrium" ? 10 : 0;
}

BenchScene peer_scene(const PeerRow& row) {
  const std::string folder = root + "/benchmarks/peer_scenes/" + row.name;
  BenchScene scene{peer_prefix + row.name,
                   folder + "/scene.xml",
                   folder + "/reference.exr",
                   {5, 20},
                   {1, 2, 3},
                   {},
                   row.bar,
                   row.aim};
  for (size_t i = 0; i < row.relmse.size(); ++i)
    scene.peers.push_back({peer_renderers[i], row.relmse[i]});
  return scene;
}

}  // namespace

std::vector<std::string> default_scene_names() {
  std::vector<std::string> names{"cornell_box", "cornell_spheres", "metal_ring",
                                 "pool_below",  "atrium",          "gallery_1"};
  for (const PeerRow& row : peer_rows) names.push_back(peer_prefix + row.name);
  return names;
}

BenchScene bench_scene(const std::string& name) {
  for (const PeerRow& row : peer_rows)
    if (name == peer_prefix + row.name) return peer_scene(row);
  std::string file = root + "/scenes/" + name + "/" + name + ".xml";
  if (!std::filesystem::exists(file)) file = root + "/benchmarks/scenes/" + name + ".xml";
  if (name.find('/') != std::string::npos || !std::filesystem::exists(file))
    throw Error(ErrorKind::input, "there is no scene '" + name + "'",
                "name a folder of scenes/, a file of benchmarks/scenes/, or peer_ and one of "
                "benchmarks/peer_scenes/");
  return {name,          file,   root + "/benchmarks/references/" + name + ".exr",
          {5, 20, 60},   {1, 2}, {},
          path_bar(name)};
}

}  // namespace kaustik::bench
