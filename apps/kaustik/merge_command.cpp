#include <fmt/format.h>

#include "commands.h"
#include "kaustik/base/file.h"
#include "kaustik/render/photon_tracing.h"

namespace kaustik::app {
namespace {

struct MergeOptions {
  std::vector<std::string> inputs;
  std::string output;
};

void merge(const MergeOptions& options) {
  check_output_path(options.output);
  std::vector<StoredPhotons> parts;
  for (const std::string& input : options.inputs) parts.push_back(read_photon_file(input));
  const StoredPhotons whole = merged_photons(parts);
  write_photon_file(options.output, whole);
  fmt::print(stderr, "wrote {}: {} global and {} caustic photons\n", options.output,
             whole.maps.global.size(), whole.maps.caustic.size());
}

}  // namespace

void add_merge(CLI::App& program) {
  CLI::App* command = program.add_subcommand(
      "merge", "Put together the parts of photon maps (kaustik photons --part) to a whole.");
  auto o = std::make_shared<MergeOptions>();
  command->add_option("parts", o->inputs, "Photon maps, all parts of one pass")->required();
  command->add_option("-o,--output", o->output, "Photon map to write, .kpm")->required();
  command->callback([o] { merge(*o); });
}

}  // namespace kaustik::app
