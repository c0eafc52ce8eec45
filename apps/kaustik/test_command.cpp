#include <fmt/format.h>

#include <cmath>

#include "commands.h"
#include "exit_codes.h"
#include "kaustik/base/error.h"
#include "kaustik/loader/nori_scene.h"
#include "kaustik/render/statistical_checks.h"
#include "kaustik/scene/deviation_report.h"
#include "option_values.h"
#include "render_job.h"
#include "scene_options.h"
#include "standard_streams.h"
#include "thread_choice.h"

namespace kaustik::app {
namespace {

struct TestOptions {
  std::string file;
  bool is_strict = false;
  int threads = 0;
  uint64_t seed = 1;
};

/// What came out of a test.
struct Outcome {
  double p_value = 1;
  std::string facts;
};

/// Nori counts no smaller variance of a sample, since its references have few digits.
constexpr double least_variance = 1e-5;

Outcome judged(const NoriTest& test, const RunningStatistics& values) {
  const double least_error = std::sqrt(least_variance / double(test.samples));
  const ConfidenceInterval interval = student_t_interval(values, 1 - test.level);
  return {t_test_p_value(values, test.expected, least_error),
          fmt::format("mean {:.6g} ± {:.2g}, expected {:.6g}", interval.mean, interval.half_width,
                      test.expected)};
}

Outcome outcome_of(const NoriTest& test, const TestOptions& options) {
  const CheckEffort effort{test.samples, options.seed, usable_threads(options.threads, false)};
  switch (test.kind) {
    case NoriTest::Kind::radiance:
      return judged(test, picture_luminances(test.description, effort));
    case NoriTest::Kind::reflectance:
      return judged(test, reflected_luminances(test.description, test.angle_degrees, effort));
    case NoriTest::Kind::density:
      break;
  }
  return {sampling_p_value(test.description, test.direction, {test.rows, test.minimum_expected},
                           effort),
          fmt::format("{} samples", test.samples)};
}

void run_tests(const TestOptions& options) {
  if (is_standard_stream(options.file))
    throw Error(ErrorKind::input, "tests are not read from standard input", "give a file");
  const std::vector<NoriTest> tests =
      read_nori_tests(options.file, load_options({}, options.is_strict));
  for (const std::string& line : deviation_lines(tests.front().description))
    terminal_messages().warn(line);
  size_t passed = 0, left_out = 0;
  for (const NoriTest& test : tests) {
    if (!test.obstacle.empty()) {
      fmt::print("not run: {}: {}\n", test.name, test.obstacle);
      ++left_out;
      continue;
    }
    const Outcome outcome = outcome_of(test, options);
    const bool has_passed = outcome.p_value >= test.level;
    passed += has_passed;
    fmt::print("{}: {}: {}, p = {:.3g} (level {:.3g})\n", has_passed ? "passed" : "failed",
               test.name, outcome.facts, outcome.p_value, test.level);
  }
  fmt::print("{} of {} tests passed{}\n", passed, tests.size() - left_out,
             left_out > 0 ? fmt::format(", {} not run", left_out) : "");
  if (passed + left_out < tests.size()) throw TestsFailed{};
}

}  // namespace

void add_test(CLI::App& program) {
  CLI::App* command = program.add_subcommand("test", "Run the statistical tests of a Nori file.");
  auto o = std::make_shared<TestOptions>();
  takes_files(command->add_option("tests", o->file, "File of tests (Nori XML)")->required(),
              {".xml"});
  add_strict(*command, o->is_strict);
  add_threads(*command, o->threads);
  command->add_option("--seed", o->seed, "Seed of the random numbers [1]");
  command->callback([o] { run_tests(*o); });
}

}  // namespace kaustik::app
