#include "benchmarks/comparisons/peer_result.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

#include "benchmarks/comparisons/error_ratio.h"
#include "benchmarks/comparisons/result_lines.h"
#include "benchmarks/markdown_table.h"

namespace kaustik::bench {
namespace {

constexpr const char* line_name = "bench-peers";

PeerResult result_of(const nlohmann::json& line) {
  PeerResult r;
  r.scene = line.at("scene");
  r.peer = line.at("peer");
  r.seconds = number_of(line.at("seconds"));
  r.start_up_seconds = number_of(line.at("start_up_seconds"));
  r.effort = line.at("effort");
  r.relmse = number_of(line.at("relmse"));
  r.integrator = line.at("integrator");
  r.our_relmse = number_of(line.at("our_relmse"));
  r.our_passes = line.at("our_passes");
  r.our_load_seconds = number_of(line.at("our_load_seconds"));
  r.mean_ratio = number_of(line.at("mean_ratio"));
  r.bar = number_of(line.at("bar"));
  r.aim = number_of(line.at("aim"));
  r.reference_relmse = number_of(line.at("reference_relmse"));
  r.threads = line.at("threads");
  r.seed = line.at("seed");
  r.program = line.at("program");
  return r;
}

std::optional<ErrorRatio> ratio_without_noise(const PeerResult& r) {
  return noiseless_ratio(r.relmse, r.our_relmse, known(r.reference_relmse));
}

Verdict verdict_of(const PeerResult& r, double bar) {
  const std::optional<ErrorRatio> ratio = ratio_without_noise(r);
  return ratio && r.has_our_mean() ? at_least(*ratio, bar) : Verdict::unknown;
}

std::string bar_of(const PeerResult& r) {
  if (!(r.bar > 0)) return "–";
  std::string text = fmt::format("{:g}: {}", r.bar, text_of(verdict_of(r, r.bar)));
  if (r.aim > r.bar) text += fmt::format(" (aim {:g}: {})", r.aim, text_of(verdict_of(r, r.aim)));
  return text;
}

}  // namespace

bool PeerResult::has_our_mean() const { return std::abs(mean_ratio - 1) <= mean_tolerance; }

std::string PeerResult::to_json_line() const {
  const nlohmann::ordered_json line{{"name", line_name},
                                    {"scene", scene},
                                    {"peer", peer},
                                    {"seconds", seconds},
                                    {"start_up_seconds", start_up_seconds},
                                    {"effort", effort},
                                    {"relmse", relmse},
                                    {"integrator", integrator},
                                    {"our_relmse", our_relmse},
                                    {"our_passes", our_passes},
                                    {"our_load_seconds", our_load_seconds},
                                    {"mean_ratio", mean_ratio},
                                    {"bar", bar},
                                    {"aim", aim},
                                    {"reference_relmse", reference_relmse},
                                    {"threads", threads},
                                    {"seed", seed},
                                    {"program", program}};
  return line.dump();
}

std::vector<PeerResult> read_peer_results(const std::string& path) {
  std::vector<PeerResult> all;
  for_each_line(path, line_name, [&](const nlohmann::json& line) {
    const PeerResult result = result_of(line);
    const auto same = std::find_if(all.begin(), all.end(), [&](const PeerResult& old) {
      return old.scene == result.scene && old.peer == result.peer;
    });
    if (same == all.end())
      all.push_back(result);
    else
      *same = result;
  });
  return all;
}

std::string peer_result_table(const std::vector<PeerResult>& results) {
  MarkdownTable table({"scene", "beside", "s", "its start-up, s", "its relative MSE", "Kaustik's",
                       "ratio", "without the reference's noise", "bar", "its mean / ours"});
  for (const PeerResult& r : results) {
    const std::optional<ErrorRatio> measured = measured_ratio(r.relmse, r.our_relmse),
                                    noiseless = ratio_without_noise(r);
    table.add({r.scene, r.peer, fmt::format("{:.1f}", r.seconds),
               fmt::format("{:.1f}", r.start_up_seconds), fmt::format("{:.2g}", r.relmse),
               fmt::format("{:.2g}", r.our_relmse), measured ? measured->text() : "–",
               noiseless ? noiseless->text() : "–", bar_of(r),
               fmt::format("{:.4f}", r.mean_ratio)});
  }
  return table.text();
}

bool all_bars_kept(const std::vector<PeerResult>& results) {
  return !results.empty() && std::all_of(results.begin(), results.end(), [](const PeerResult& r) {
    return !(r.bar > 0) || verdict_of(r, r.bar) == Verdict::kept;
  });
}

}  // namespace kaustik::bench
