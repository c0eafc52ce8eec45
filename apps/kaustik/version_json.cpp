#include "version_json.h"
#include "kaustik/base/processors.h"

#include <vector>

#include "build_facts.h"
#include "json_object.h"
#include "kaustik/base/version.h"

namespace kaustik::app {
namespace {

JsonObject library_versions() {
  const std::vector<std::string> names_and_versions{KAUSTIK_LIBRARIES};
  JsonObject libraries;
  for (size_t i = 0; i + 1 < names_and_versions.size(); i += 2)
    libraries.add(names_and_versions[i], names_and_versions[i + 1]);
  return libraries;
}

/// Sets of vector instructions that Highway and Embree choose among.
std::vector<std::string> vector_instructions() {
  std::vector<std::string> names;
#if defined(__x86_64__)
  if (__builtin_cpu_supports("sse4.2")) names.emplace_back("sse4.2");
  if (__builtin_cpu_supports("avx")) names.emplace_back("avx");
  if (__builtin_cpu_supports("avx2")) names.emplace_back("avx2");
  if (__builtin_cpu_supports("fma")) names.emplace_back("fma");
  if (__builtin_cpu_supports("avx512f")) names.emplace_back("avx512f");
#endif
  return names;
}

}  // namespace

std::string version_json() {
  const Processors here = processors();
  return JsonObject()
      .add("name", "kaustik")
      .add("version", KAUSTIK_VERSION)
      .add("compiler", KAUSTIK_COMPILER)
      .add("build", KAUSTIK_BUILD_TYPE)
      .add("system", KAUSTIK_SYSTEM)
      .add("libraries", library_versions())
      .add("processors", uint64_t(here.of_machine))
      .add("threads", uint64_t(here.usable()))
      .add("vector_instructions", vector_instructions())
      .text();
}

}  // namespace kaustik::app
