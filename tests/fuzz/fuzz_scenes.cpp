// Builds and renders scenes made from the parameter tables, in processes of their own:
//   fuzz_scenes [--first SEED] [--scenes COUNT] [--jobs COUNT] [--xml] [--refusals]
// Each scene is a function of its seed. --xml only prints the scenes, --refusals also
// prints the errors that refuse a scene. Ends with 1 if anything was
// wrong: an abort, what a sanitizer finds, a hang, a pixel that is not finite, an exception that is
// no Error, an Error without a place; or if too few of the pictures were made.

#include <fmt/format.h>
#include <sys/mman.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <new>
#include <thread>
#include <vector>

#include "kaustik/base/processors.h"
#include "tests/fuzz/scene_grammar.h"
#include "tests/fuzz/worker.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace kaustik::fuzz;

/// Scenes that are refused test little: of so many scenes this share of the pictures must be made.
constexpr uint64_t enough_for_share = 30;
constexpr double least_share = 0.4;

struct Options {
  uint64_t first = 1, scenes = 100, jobs = uint64_t(kaustik::usable_processors());
  bool only_print = false, tells_refusals = false;
};

Options options_from(int count, char** arguments) {
  Options options;
  for (int i = 1; i < count; ++i) {
    const std::string name = arguments[i];
    uint64_t* const number = name == "--first"    ? &options.first
                             : name == "--scenes" ? &options.scenes
                             : name == "--jobs"   ? &options.jobs
                                                  : nullptr;
    if (number && i + 1 < count)
      *number = std::strtoull(arguments[++i], nullptr, 10);
    else if (name == "--xml")
      options.only_print = true;
    else if (name == "--refusals")
      options.tells_refusals = true;
    else
      fmt::print(stderr, "unknown argument '{}'\n", name), std::exit(2);
  }
  if (options.scenes == 0 || options.jobs == 0)
    fmt::print(stderr, "scenes and jobs must be numbers of at least 1\n"), std::exit(2);
  return options;
}

Counts& shared_counts() {
  void* shared =
      mmap(nullptr, sizeof(Counts), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED) throw std::bad_alloc();
  return *new (shared) Counts;
}

void check_all(const Options& options, const std::string& folder, Counts& counts) {
  std::vector<std::unique_ptr<Worker>> workers;
  for (uint64_t i = 0; i < options.jobs; ++i)
    workers.push_back(std::make_unique<Worker>(options.first + i, options.first + options.scenes,
                                               options.jobs, folder, options.tells_refusals,
                                               counts));
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::minutes between{1};
  auto next = Clock::now() + between;
  bool busy = true;
  while (busy) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    if (Clock::now() > next) {
      fmt::print(stderr, "{} of {} scenes\n", counts.scenes.load(), options.scenes);
      next = Clock::now() + between;
    }
    busy = false;
    for (const auto& worker : workers) busy |= worker->attend();
  }
}

}  // namespace

int main(int count, char** arguments) {
  const Options options = options_from(count, arguments);
  const kaustik::test::TemporaryFolder temporary;
  const std::string folder = temporary.path("files");
  std::filesystem::create_directory(folder);
  write_files(folder);
  if (options.only_print) {
    for (uint64_t i = 0; i < options.scenes; ++i) {
      const GeneratedScene scene = generate_scene(options.first + i, folder);
      std::string all;
      for (const auto& integrator : scene.integrators) all += integrator.xml;
      fmt::print("{}\n", scene.with(all));
    }
    return 0;
  }
  const auto start = std::chrono::steady_clock::now();
  Counts& counts = shared_counts();
  check_all(options, folder, counts);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const double share = double(counts.renders) / double(std::max<uint64_t>(1, counts.wanted));
  fmt::print(
      "{} scenes ({} refused), {} pictures, {:.0f} % of those that were wanted ({} refused, {} "
      "with samples that were not finite, {} "
      "with rays that left the range of floats), {} failures, {:.0f} s\n",
      counts.scenes.load(), counts.refused.load(), counts.renders.load(), 100 * share,
      counts.renders_refused.load(), counts.dropped.load(), counts.with_lost_rays.load(),
      counts.failures.load(), seconds);
  if (options.scenes >= enough_for_share && share < least_share) {
    fmt::print(stderr,
               "fewer than {:.0f} % of the pictures were made: too many scenes are refused\n",
               100 * least_share);
    return 1;
  }
  return counts.failures > 0 ? 1 : 0;
}
