#include "kaustik/scene/film_settings.h"

namespace kaustik {

const std::vector<TypeInfo>& sampler_infos() {
  static const std::vector<TypeInfo> infos = [] {
    std::vector<TypeInfo> list;
    for (const char* name : {"independent", "stratified", "multijitter", "orthogonal", "ldsampler",
                             "halton", "hammersley", "sobol", "sobolseq", "faure", "deterministic"})
      list.push_back(
          {"sampler",
           name,
           "Kaustik has one sampler (Owen-scrambled Sobol points), so only the count is used.",
           {integer_parameter("sample_count", 4, "Samples per pixel.").range(1, 1 << 24),
            ignored_parameter("seed", ParameterKind::integer),
            ignored_parameter("jitter", ParameterKind::boolean),
            ignored_parameter("dimension", ParameterKind::integer),
            ignored_parameter("strength", ParameterKind::integer),
            ignored_parameter("scramble", ParameterKind::integer)}});
    return list;
  }();
  return infos;
}

}  // namespace kaustik
