// docs/ablation.md, of what `make ablation` has measured: `ablation_page RESULTS [DOCS]`; without a
// folder the tables go to standard output.
#include <fmt/format.h>

#include <filesystem>
#include <set>

#include "benchmarks/comparisons/ablation.h"
#include "kaustik/base/error.h"
#include "kaustik/base/file.h"

namespace kaustik::bench {
namespace {

std::string facts(const std::vector<Measurement>& measurements) {
  std::set<std::string> programs;
  std::set<uint64_t> seeds;
  std::set<double> seconds;
  std::set<int> threads;
  bool by_cpu_time = false;
  for (const Measurement& m : measurements) {
    programs.insert(m.program);
    seeds.insert(m.seed);
    seconds.insert(m.seconds.back());
    threads.insert(m.threads);
    by_cpu_time |= m.by_cpu_time;
  }
  return fmt::format(
      "{} runs of {:g} to {:g} s{} on {} threads, {} seeds, {} build{} of the program.",
      measurements.size(), *seconds.begin(), *seconds.rbegin(),
      by_cpu_time ? " of CPU time over threads" : "", *threads.begin(), seeds.size(),
      programs.size(), programs.size() == 1 ? "" : "s");
}

std::string page(const std::vector<Measurement>& measurements) {
  const Ablation ablation(measurements);
  return fmt::format(
      "# What each device of `auto` is worth\n\n"
      "`auto` learns, chooses and guides by itself. Here each of these is switched off alone: the "
      "error without it over the error with\nit at equal time, so that more than 1 speaks for it. "
      "Relative MSE, without the reference's noise; ± is one standard error over\nthe seeds. "
      "A device is to lower the error by a tenth on some scene that people could have (1.1), and "
      "to raise it by more than a\ntwentieth on none (0.95); what can't be told at 95 % for all "
      "scenes together is left open. Of `pool_among_lamps` and\n`hundredth_of_a_floor` the "
      "reference is `auto` itself, of a long run: bias that both have does not show there.\n\n"
      "`make ablation` writes this page: {}\n\n"
      "{}\n## Scene by scene\n\n{}",
      facts(measurements), verdict_table(ablation), worth_table(ablation));
}

void write(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::create_directories(path.parent_path());
  write_file_atomically(path.string(),
                        {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

int run(const std::string& results, const std::string& docs) {
  const std::vector<Measurement> measurements = read_measurements(results);
  if (measurements.empty())
    throw Error(ErrorKind::input, "there are no measurements in '" + results + "'",
                "measure first: make ablation");
  const std::string text = page(measurements);
  if (docs.empty())
    fmt::print("{}", text);
  else
    write(std::filesystem::path(docs) / "ablation.md", text);
  return 0;
}

}  // namespace
}  // namespace kaustik::bench

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    fmt::print(stderr, "usage: ablation_page RESULTS [DOCS]\n");
    return 2;
  }
  try {
    return kaustik::bench::run(argv[1], argc > 2 ? argv[2] : "");
  } catch (const kaustik::Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
}
