#include "kaustik/vcm/light_pass.h"

#include <algorithm>

#include "kaustik/base/parallel.h"
#include "kaustik/vcm/light_path/tracer.h"

namespace kaustik {
namespace {

constexpr size_t paths_per_block = 1024;

}  // namespace

LightVertices trace_light_vertices(const VcmLightInputs& inputs, const Pass& pass, Stream stream,
                                   SplatBuffer& splats, std::stop_token stop,
                                   const ProgressFunction& progress, PassReport& report) {
  std::vector<LightBlock> blocks((inputs.light_paths + paths_per_block - 1) / paths_per_block);
  WorkCounter counter(inputs.light_paths, progress);
  parallel_blocks(inputs.light_paths, paths_per_block, [&](size_t begin, size_t end, size_t i) {
    if (stop.stop_requested()) return;
    blocks[i] = trace_light_block(inputs, pass, stream, splats, uint32_t(begin), uint32_t(end));
    counter.add(end - begin);
  });
  // Nobody looks at a part of the light; to put it in order would take its time.
  if (stop.stop_requested()) return {};
  size_t merging = 0, connectible = 0;
  for (const LightBlock& block : blocks) {
    report.rays += block.rays;
    report.photons += block.splats;
    merging += block.data.size() + block.in_media.size() + block.at_gauges.size();
    connectible += block.connectible.size();
  }
  const bool merges = inputs.weights.settings().techniques.merging && merging > 0;
  report.photons += merges ? merging : connectible;
  LightVertices result = join(blocks, inputs.scene.gauges().size(), inputs.gauges, stop);
  result.wavelengths = pass.wavelengths[inputs.set];
  result.path_count = inputs.light_paths;
  result.remembered_paths = std::min(inputs.remembered_paths, inputs.light_paths);
  return result;
}

}  // namespace kaustik
