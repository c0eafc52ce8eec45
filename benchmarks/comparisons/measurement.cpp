#include "benchmarks/comparisons/measurement.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <limits>

#include "benchmarks/comparisons/result_lines.h"
#include "kaustik/base/checksum.h"
#include "kaustik/base/error.h"
#include "kaustik/base/file.h"

namespace kaustik::bench {
namespace {

constexpr const char* line_name = "bench-scenes";
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

std::vector<double> numbers_of(const nlohmann::json& values) {
  std::vector<double> numbers;
  for (const nlohmann::json& value : values) numbers.push_back(number_of(value));
  return numbers;
}

Measurement measurement_of(const nlohmann::json& line) {
  Measurement m;
  m.scene = line.at("scene");
  m.integrator = line.at("integrator");
  m.seed = line.at("seed");
  m.seconds = numbers_of(line.at("seconds"));
  m.relmse = numbers_of(line.at("relmse"));
  m.relmse.resize(m.seconds.size(), not_a_number);
  m.seconds_taken = numbers_of(line.at("seconds_taken"));
  m.mean_ratio = number_of(line.at("mean_ratio"));
  m.threads = line.at("threads");
  m.passes = line.at("passes");
  m.samples_per_pass = line.at("samples_per_pass");
  m.load_seconds = number_of(line.at("load_seconds"));
  m.cpu_share = number_of(line.at("cpu_share"));
  m.reference_relmse = number_of(line.at("reference_relmse"));
  m.reference_mean_ratio = number_of(line.value("reference_mean_ratio", nlohmann::json()));
  m.program = line.at("program");
  m.inputs = line.at("inputs");
  return m;
}

}  // namespace

std::optional<double> Measurement::relmse_at(double time) const {
  for (size_t i = 0; i < seconds.size(); ++i)
    if (seconds[i] == time) return relmse[i];
  return std::nullopt;
}

std::string Measurement::to_json_line() const {
  const nlohmann::ordered_json line{{"name", line_name},
                                    {"scene", scene},
                                    {"integrator", integrator},
                                    {"seed", seed},
                                    {"seconds", seconds},
                                    {"relmse", relmse},
                                    {"seconds_taken", seconds_taken},
                                    {"mean_ratio", mean_ratio},
                                    {"threads", threads},
                                    {"passes", passes},
                                    {"samples_per_pass", samples_per_pass},
                                    {"load_seconds", load_seconds},
                                    {"cpu_share", cpu_share},
                                    {"reference_relmse", reference_relmse},
                                    {"reference_mean_ratio", reference_mean_ratio},
                                    {"program", program},
                                    {"inputs", inputs}};
  return line.dump();
}

std::vector<Measurement> read_measurements(const std::string& path) {
  std::vector<Measurement> all;
  for_each_line(path, line_name,
                [&](const nlohmann::json& line) { all.push_back(measurement_of(line)); });
  return all;
}

void append_line(const std::string& path, const std::string& line) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  if (!folder.empty()) std::filesystem::create_directories(folder);
  std::ofstream file(path, std::ios::app);
  file << line << std::endl;
  if (!file) throw Error(ErrorKind::system, path + " cannot be written");
}

std::string picture_path(const std::string& results, const std::string& scene,
                         const std::string& integrator) {
  const std::filesystem::path folder =
      std::filesystem::path(results).replace_extension().string() + "_pictures";
  return (folder / (scene + "-" + integrator + ".exr")).string();
}

std::string checksum_of_file(const std::string& path) {
  return fmt::format("{:016x}", checksum(read_file(path)));
}

}  // namespace kaustik::bench
