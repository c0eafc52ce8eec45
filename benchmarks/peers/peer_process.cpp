#include "benchmarks/peers/peer_process.h"

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

#include "kaustik/base/error.h"

namespace kaustik::bench {

TemporaryFolder::TemporaryFolder() {
  std::string pattern = std::filesystem::temp_directory_path() / "kaustik_peer_XXXXXX";
  if (!::mkdtemp(pattern.data())) throw Error(ErrorKind::system, "no temporary folder");
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

bool is_installed(const std::string& program) {
  return std::system(("command -v " + program + " >/dev/null").c_str()) == 0;
}

std::string run_peer(const std::string& command, const TemporaryFolder& folder) {
  const std::string log = folder / "log.txt";
  const int status = std::system(fmt::format("{} >'{}' 2>&1", command, log).c_str());
  std::ifstream file(log);
  std::string text(std::istreambuf_iterator<char>(file), {});
  if (status != 0) throw Error(ErrorKind::system, "this failed: " + command + "\n" + text);
  return text;
}

}  // namespace kaustik::bench
